"""At what horizontal acceleration does Oppenheim's arch begin to fall, and how?

Oppenheim's arch has the centreline radius 10 m, the thickness 1.5 m, 157.5 deg of a circle and seven
voussoirs; friction is large enough that none slides. Its weight is the dead load, and alpha times its
weight acts horizontally: a constant ground acceleration alpha g. At collapse the line of thrust touches the
surface at four joints, on alternate sides. These are hinges, and the parts between them move:

    Fc + alpha Fv = C^T Q,    |e| <= t/2 at every joint,    e = M/N,    |e| = t/2 at the hinges

Oppenheim found 0.37 g. That is the threshold of motion, not of collapse: an arch on which a pulse acts may
rock and come to rest.

Source: Oppenheim (1992), The masonry arch as a four-link mechanism under base motion, Earthquake Eng.
Struct. Dyn. 21, 1005-1017; the same arch in De Lorenzis, DeJong & Ochsendorf (2007), 0.37 g.
"""

from pathlib import Path

import numpy as np

import limitblocks as lb


def main(folder="output"):
    arch = lb.structures.arch(
        lb.PointContact(friction=0.8), radius=10.0, thickness=1.5, voussoirs=7, embrace=np.radians(157.5)
    )
    bounds = lb.bounds(arch)
    states = lb.interface_states(arch, bounds)
    hinges = [name for name, state in zip(states.names, states.state, strict=True) if "hinge" in state]
    print(bounds)
    print(f"the arch begins to fall at {bounds.lower:.4f} g; Oppenheim: 0.37 g")
    print(f"hinges: {', '.join(hinges)}")
    picture(Path(folder), arch, bounds)
    return {"load factor": bounds.lower, "hinges": len(hinges)}


def picture(folder, arch, bounds):
    import matplotlib.pyplot as plt

    plt.style.use("limitblocks.plots.paper")
    figure, axes = plt.subplots(1, 2, figsize=(7, 2.8))
    lb.plots.thrust_line(arch, bounds, ax=axes[0])
    axes[0].set_title("Line of thrust")
    lb.plots.mechanism(arch, bounds, ax=axes[1])
    axes[1].set_title(f"Mechanism at {bounds.lower:.3f} g")
    folder.mkdir(parents=True, exist_ok=True)
    figure.savefig(folder / "11_oppenheims_arch.png")
    plt.close(figure)


if __name__ == "__main__":
    main()
