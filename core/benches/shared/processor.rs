//! The processor at hand: its name, and the instruction sets that kernels are compiled for.

/// Instruction sets, named as `HERTZIAN_INSTRUCTIONS` names them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Instructions {
    /// What every processor of the kind has.
    Baseline,
    /// AVX2 and FMA.
    Avx2,
    /// AVX-512 F, VL, DQ, and FMA.
    Avx512,
}

impl Instructions {
    pub fn all() -> [Self; 3] {
        [Self::Baseline, Self::Avx2, Self::Avx512]
    }

    /// Those that this processor has.
    pub fn present() -> Vec<Self> {
        Self::all().into_iter().filter(|i| i.is_present()).collect()
    }

    pub fn name(self) -> &'static str {
        match self {
            Self::Baseline => "baseline",
            Self::Avx2 => "avx2",
            Self::Avx512 => "avx512",
        }
    }

    #[cfg(target_arch = "x86_64")]
    pub fn is_present(self) -> bool {
        let fma = is_x86_feature_detected!("fma");
        match self {
            Self::Baseline => true,
            Self::Avx2 => fma && is_x86_feature_detected!("avx2"),
            Self::Avx512 => {
                fma && is_x86_feature_detected!("avx512f")
                    && is_x86_feature_detected!("avx512vl")
                    && is_x86_feature_detected!("avx512dq")
            }
        }
    }

    #[cfg(not(target_arch = "x86_64"))]
    pub fn is_present(self) -> bool {
        self == Self::Baseline
    }
}

/// Name of the processor and its instruction sets, in one line.
pub fn description() -> String {
    let sets: Vec<&str> = Instructions::present()
        .into_iter()
        .map(Instructions::name)
        .collect();
    format!("{}; {}", name(), sets.join(", "))
}

fn name() -> String {
    let known = std::fs::read_to_string("/proc/cpuinfo")
        .ok()
        .and_then(|text| {
            let field = |name: &str| {
                let line = text.lines().find(|line| line.starts_with(name))?;
                line.split(':').nth(1).map(|value| value.trim().to_owned())
            };
            let (family, model) = (field("cpu family")?, field("model\t")?);
            Some(format!(
                "{}, family {family}, model {model}",
                field("model name")?
            ))
        });
    known.unwrap_or_else(|| std::env::consts::ARCH.to_owned())
}
