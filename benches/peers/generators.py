"""C and C++ sources of the power law from CasADi, SymPy and SymForce, and CasADi's own evaluation.

    phi = 2 zeta r + sgn(g) |g|^alpha

with its derivatives by g and r, and by alpha unless alpha is 3/2. Each generator writes a function of one sample with
common subexpressions shared; around it goes a loop in the same file, so that the C compiler can merge and vectorise both.
With `told`, a runtime power is given as exp(alpha ln |g|), which shares the exponential between the derivatives.
"""

import contextlib
import pathlib
import tempfile

NAMES = ["force", "by_gap", "by_rate", "by_alpha"]

SIGNATURE = """(const double *restrict gap, const double *restrict rate, double zeta, double alpha,
    double *restrict force, double *restrict by_gap, double *restrict by_rate, double *restrict by_alpha, long count)"""


def outputs(exponent):
    """The outputs: three, and the derivative by the exponent where it is a variable."""
    return NAMES if exponent == "power" else NAMES[:3]


def casadi_function(exponent, told=False, count=1):
    """The law of `count` samples as a function of CasADi, derived by CasADi.

    One sample is an expression of scalars, several are one of arrays: what CasADi evaluates fastest, and what it writes the
    fastest code from.
    """
    import casadi as ca

    kind = ca.SX if count == 1 else ca.MX
    gap, rate = (kind.sym(name, count) for name in ["gap", "rate"])
    zeta, alpha = (kind.sym(name) for name in ["zeta", "alpha"])
    power = _power(exponent, told, ca.fabs(gap), alpha, ca.exp, ca.log, 1.5)
    force = 2 * zeta * rate + ca.sign(gap) * power
    # Samples do not depend on each other, so the derivative along ones is that of each.
    along = [(gap, kind.ones(count)), (rate, kind.ones(count)), (alpha, kind(1))]
    values = [force] + [ca.jtimes(force, by, ones) for by, ones in along]
    names = outputs(exponent)
    inputs = ["gap", "rate", "zeta", "alpha"]
    return ca.Function("law", [gap, rate, zeta, alpha], values[: len(names)], inputs, names, {"cse": True})


def casadi(exponent, told):
    """C source by CasADi's code generation, sample by sample."""
    source, _ = _casadi_source(casadi_function(exponent, told))
    results = ", ".join(f"&{name}[i]" for name in outputs(exponent))
    return "c", f"""{source}
void kernel{SIGNATURE} {{
    for (long i = 0; i < count; i++) {{
        const double *arguments[] = {{&gap[i], &rate[i], &zeta, &alpha}};
        double *results[] = {{{results}}};
        casadi_f0(arguments, results, 0, 0, 0);
    }}
}}
"""


def casadi_arrays(exponent, told, count):
    """C source by CasADi's code generation, for arrays of `count` samples."""
    source, room = _casadi_source(casadi_function(exponent, told, count))
    return "c", f"""{source}
void kernel{SIGNATURE} {{
    static double room[{room}];
    const double *arguments[16] = {{gap, rate, &zeta, &alpha}};
    double *results[16] = {{{", ".join(outputs(exponent))}}};
    casadi_f0(arguments, results, 0, room, 0);
}}
"""


def _casadi_source(function):
    """The file that CasADi writes, and the working memory that its function needs."""
    # It writes where it is, and nowhere else.
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
        function.generate("law.c")
        return pathlib.Path("law.c").read_text(), max(1, function.sz_w())


def sympy(exponent, told):
    """C source by SymPy: `cse`, then the C printer."""
    import sympy as sp

    gap, rate, zeta, alpha = sp.symbols("gap rate zeta alpha", real=True)
    power = _power(exponent, told, sp.Abs(gap), alpha, sp.exp, sp.log, sp.Rational(3, 2))
    force = 2 * zeta * rate + sp.sign(gap) * power
    values = [force] + [sp.diff(force, by) for by in [gap, rate, alpha]]
    # Away from the level, where the derivative of the sign is Dirac's impulse.
    values = [value.replace(sp.DiracDelta, lambda *_: sp.Integer(0)) for value in values]
    names = outputs(exponent)
    shared, values = sp.cse(values[: len(names)])
    lines = [f"const double {name} = {sp.ccode(value)};" for name, value in shared]
    lines += [f"*{name} = {sp.ccode(value)};" for name, value in zip(names, values)]
    body = "\n    ".join(lines)
    pointers = ", ".join(f"double *{name}" for name in names)
    places = ", ".join(f"&{name}[i]" for name in names)
    return "c", f"""#include <math.h>
static inline void law(double gap, double rate, double zeta, double alpha, {pointers}) {{
    {body}
}}
void kernel{SIGNATURE} {{
    for (long i = 0; i < count; i++) law(gap[i], rate[i], zeta, alpha, {places});
}}
"""


def symforce(exponent, told):
    """C++ source by SymForce."""
    import logging

    logging.disable(logging.WARNING)
    import symforce.symbolic as sf
    from symforce.codegen import Codegen, CppConfig

    names = outputs(exponent)

    def law(gap: sf.Scalar, rate: sf.Scalar, zeta: sf.Scalar, alpha: sf.Scalar):
        power = _power(exponent, told, sf.Abs(gap), alpha, sf.exp, sf.log, sf.Rational(3, 2))
        force = 2 * zeta * rate + sf.sign_no_zero(gap) * power
        values = [force] + [force.diff(by) for by in [gap, rate, alpha]]
        return tuple(values[: len(names)])

    with tempfile.TemporaryDirectory() as folder:
        config = CppConfig(use_eigen_types=False)
        Codegen.function(law, config=config, output_names=names).generate_function(output_dir=folder)
        (header,) = pathlib.Path(folder).rglob("law.h")
        # Scalars only: of Eigen, which the template includes, nothing is used.
        source = header.read_text().replace("#include <Eigen/Core>", "#include <cmath>")
    places = ", ".join(f"&{name}[i]" for name in names)
    signature = SIGNATURE.replace("restrict", "__restrict")
    return "cpp", f"""{source}
extern "C" void kernel{signature} {{
    for (long i = 0; i < count; i++) sym::Law<double>(gap[i], rate[i], zeta, alpha, {places});
}}
"""


def _power(exponent, told, size, alpha, exp, log, three_halves):
    if exponent != "power":
        return size**three_halves
    return exp(alpha * log(size)) if told else size**alpha
