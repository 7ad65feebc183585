"""The figure of docs/performance.md: times over coordinates, both axes logarithmic."""

import matplotlib
import matplotlib.pyplot as plt
from matplotlib.ticker import FormatStrFormatter, ScalarFormatter

# Okabe and Ito's colours, distinguishable with all kinds of colour vision; the markers work without colour.
STYLES = {
    "ours": ("#000000", "o"),
    "ours, 8 lanes, each": ("#E69F00", "*"),
    "Pinocchio, gcc": ("#56B4E9", "s"),
    "Pinocchio, clang": ("#0072B2", "D"),
    "CasADi C, gcc": ("#F0E442", "^"),
    "CasADi C, clang": ("#009E73", "v"),
    "MuJoCo": ("#CC79A7", "P"),
    "Exudyn": ("#D55E00", "X"),
    "triple sum of the print": ("#999999", "x"),
}
PANELS = {
    "forward_dynamics": ("Forward dynamics", {"ours, 8 lanes, each": "forward_dynamics_lanes"}),
    "mass_matrix_and_bias": ("A and e", {"triple sum of the print": "triple_sum"}),
    "rk4_step": ("RK4 step with all forces", {}),
}


def draw(times, path, series):
    """Draws one panel per quantity."""
    # The same numbers give the same file; text stays text.
    matplotlib.use("svg")
    matplotlib.rcParams.update({"svg.hashsalt": "crane", "svg.fonttype": "none", "font.size": 9})
    drawing, axes = plt.subplots(1, len(PANELS), figsize=(11, 4.2), layout="constrained")
    for panel, (quantity, (title, kernels)) in zip(axes, PANELS.items()):
        lines = {"ours": lambda n, q=quantity: times.of_quantity(n, q)}
        lines |= {name: lambda n, k=kernel: times.ours(n, k) for name, kernel in kernels.items()}
        lines |= {name: lambda n, q=quantity, s=name: times.series(n, q, s) for name in series}
        for name, line in lines.items():
            points = [(n, time / 1000) for n in times.coordinates if (time := line(n))]
            if points:
                color, marker = STYLES[name]
                panel.loglog(*zip(*points), color=color, marker=marker, label=name, mec="black", mew=0.4)
        panel.set(title=title, xlabel="coordinates [1]", ylabel="time [µs]")
        panel.set_xticks(times.coordinates, minor=False)
        panel.set_xticks([], minor=True)
        panel.xaxis.set_major_formatter(ScalarFormatter())
        panel.yaxis.set_major_formatter(FormatStrFormatter("%g"))
        panel.grid(True, which="both", linewidth=0.3)
        panel.legend(fontsize=7)
    path.parent.mkdir(parents=True, exist_ok=True)
    drawing.savefig(path, metadata={"Date": None})
    plt.close(drawing)
