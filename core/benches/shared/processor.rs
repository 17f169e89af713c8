//! The processor at hand.

use hertzian::power::Instructions;

/// The instruction sets that this processor has.
pub fn instructions() -> impl Iterator<Item = Instructions> {
    let all = Instructions::ALL.into_iter();
    all.filter(|set| set.is_available())
}

/// Name of the processor and its instruction sets, in one line.
pub fn description() -> String {
    let sets: Vec<&str> = instructions().map(Instructions::name).collect();
    format!("{}; {}", name(), sets.join(", "))
}

fn name() -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let field = |name: &str| {
        let line = text.lines().find(|line| line.starts_with(name))?;
        line.split(':').nth(1).map(|value| value.trim().to_owned())
    };
    let known = [field("model name"), field("cpu family"), field("model\t")];
    let [Some(name), Some(family), Some(model)] = known else {
        return std::env::consts::ARCH.to_owned();
    };
    format!("{name}, family {family}, model {model}")
}
