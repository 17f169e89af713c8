/// The setters of a type that is set up step by step: each takes it, does what its braces say, and gives it back.
///
/// `from(value: f64) { self.from = Some(value) }` behind `setters! { self:` is
///
/// ```text
/// #[must_use]
/// pub fn from(mut self, value: f64) -> Self {
///     self.from = Some(value);
///     self
/// }
/// ```
#[doc(hidden)]
#[macro_export]
macro_rules! setters {
    ($this:ident: $($(#[$about:meta])* $name:ident($($argument:ident: $of:ty),*) $set:block)*) => {$(
        $(#[$about])*
        #[must_use]
        pub fn $name(mut $this, $($argument: $of),*) -> Self {
            $set;
            $this
        }
    )*};
}
