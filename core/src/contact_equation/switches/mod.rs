//! Which switches an orbit has, and in which pairs they are told: planned from samples of a motion ([`plan`]), or from an orbit of other
//! equations ([`transfer`]), into which a branch goes over ([`replan`]), or which are told by other [`shapes`] of their gaps. Whether those of the present equations still are right is told
//! in [`fits`].

pub(super) mod fits;
pub(super) mod plan;
pub(super) mod replan;
pub(super) mod shapes;
pub(super) mod transfer;
