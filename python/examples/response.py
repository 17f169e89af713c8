"""The response of a contact oscillator: what is stable, what is not, where it folds, and one motion with its contact force.

    pip install ./python matplotlib
    python python/examples/response.py

Change the declaration, the parameters and the range to what you have.
"""

import matplotlib.pyplot as plt
import numpy as np

import hertzian

model = hertzian.Model(
    """
    OneSided(x) {
        /// damping ratio
        param zeta in 0.0..;
        /// normal load W
        param load;
        /// excitation amplitude A
        param drive;
        law contact(gap) { gap > 0 => 2*zeta*dot(gap) + gap^1.5, else => 0 }
        ddot(x) + contact(x) = drive*cos(omega*t) + load;
    }
    """,
    zeta=0.032,
    load=1.0,
    drive=0.1,
)
branch = model.response(0.6, 1.6)
print(branch)

figure, (response, motion) = plt.subplots(1, 2, figsize=(11, 4.2), constrained_layout=True)

# Stable solid, unstable dashed, where neither is certain dotted.
lines = {"stable": "-", "unstable": "--", "undecided": ":"}
for run in branch.runs("x:p2p"):
    response.plot(*run.points.T, lines[run.verdict], color="C0", label=run.verdict)
for fold in branch.folds:
    print(fold)
    response.plot(fold.value, fold.point.peak_to_peak, "ko", markersize=5, label="fold")
handles = dict(zip(*response.get_legend_handles_labels()[::-1]))
response.legend(handles.values(), handles.keys(), frameon=False)
response.set(xlabel="excitation frequency ω", ylabel="peak-to-peak of x")

# The largest motion at a frequency, over a period.
point = max(branch.at(0.8), key=lambda point: point.peak_to_peak)
times = np.linspace(0.0, 2 * np.pi / point.orbit.base, 400)
x, _ = point.orbit.state_at("x", times)
force = point.reading("contact").value(times)
motion.plot(times, x, label="x")
motion.plot(times, force, "--", label="force of the contact")
motion.axhline(0.0, color="0.7", linewidth=0.8)
motion.set(xlabel="time", title=f"{point.stability.verdict} at ω = {point.omega}")
motion.legend(frameon=False)

figure.savefig("response.png", dpi=120)
