"""Can two different load factors of one structure both be right?

A block of weight W stands between floor and ceiling, both rigid, and fits exactly. Friction is mu; alpha W
pushes it sideways; sliding does not lift it. The ceiling may press on the block by any force P from nothing
up: nothing in statics or in the flow rule decides. Then the floor carries W + P, and both faces slide:

    alpha W = mu (W + P) + mu P,    alpha = mu (1 + 2 P/W) >= mu

Every such alpha, with its forces and its mechanism (the block slides along), satisfies all conditions, Eqs
(54)-(59). Here P = 0 and P = W are put in by hand, and the check passes both. With dilatancy the block
could not slide at all, and the associated load factor is unlimited. So the bracket, from the value without
friction, 0, to the associated one, says that no number of this structure is its strength; only mu is on the
safe side.

What decides in reality is how tightly the block was fitted. `load_path` decides by its starting state:
`start=` another one, and the answer is another. From P = W the block slides before it tips, and P stays. From
P = 0 it tips a little and presses against the ceiling by what the compliance of the joints makes of that, so
that the answer is a third one; it lies on the same line. So does that of `nonassociated`, whose path adds
next to nothing to P.

Source: Drucker (1954), J. Appl. Mech. 21, 71-74; the complementarity problem and its many solutions: Orduña
& Lourenço (2005), Part I, Section 5.
"""

from pathlib import Path

import numpy as np

import limitblocks as lb

FRICTION = 0.3
PRESSES = (0.0, 1.0)  # P/W


def main(folder="output"):
    model = jammed_block()
    claims = [claim(model, press) for press in PRESSES]
    checks = [lb.check_mcp(model, one) for one in claims]
    for press, one, check in zip(PRESSES, claims, checks, strict=True):
        print(f"P = {press:g} W: load factor {one.load_factor:.2f}, {check}")
        check.require()
    started = [lb.load_path(model, start=at_rest(model, press)).collapse for press in PRESSES]
    tracked = lb.nonassociated(model, start=at_rest(model, PRESSES[1]))
    for press, found in zip(PRESSES, started, strict=True):
        print(f"started from P = {press:g} W, ended at {pressing(model, found):.4f} W: {found}")
    print(
        f"by the tracked path from P = {PRESSES[1]:g} W, ended at {pressing(model, tracked):.4f} W: {tracked}"
    )
    picture(Path(folder), model, claims, started)
    return {
        "claimed": [one.load_factor for one in claims],
        "worst residual": max(check.worst.value for check in checks),
        "started from P = W": started[1].load_factor,
        "frictionless": started[0].frictionless,
        "associated": started[0].associated,
        "found less the rule": [
            found.load_factor - FRICTION * (1 + 2 * pressing(model, found)) for found in (*started, tracked)
        ],
    }


def jammed_block():
    """A cube of 1 m between floor and ceiling, pushed along X."""
    stones = [
        lb.Block.box("floor", (3.0, 1.0, 0.2), (0, 0, -0.1)),
        lb.Block.box("ceiling", (3.0, 1.0, 0.2), (0, 0, 1.1)),
        lb.Block.box("block", (1.0, 1.0, 1.0), (0, 0, 0.5), unit_weight=20e3),
    ]
    interfaces = lb.find_interfaces(stones, lb.OrdunaLourenco(FRICTION))
    push = lb.mass_proportional((1, 0, 0))
    return lb.Model(stones, ["floor", "ceiling"], interfaces, lb.self_weight(), push)


def claim(model, press):
    """The state in which both faces slide under the ceiling force P = `press` W, by hand."""
    weight = model.free_blocks[0].weight
    P, V = press * weight, FRICTION * (1 + press) * weight
    # on the block, and where they act: that of the floor moves towards the front edge
    forces = {
        "floor": ((-V, 0, weight + P), (FRICTION * weight / 2 / (weight + P), 0, 0)),
        "ceiling": ((-FRICTION * P, 0, -P), (0, 0, 1)),
    }
    slides = [
        (0.0,) * 6 if block.name in model.supports else (1 / weight, 0, 0, 0, 0, 0) for block in model.blocks
    ]
    return lb.results.Claim(FRICTION * (1 + 2 * press), resultants(model, forces), np.array(slides))


def at_rest(model, press):
    """Stress resultants under the weight and the ceiling force P, without any push."""
    weight = model.free_blocks[0].weight
    P = press * weight
    forces = {"floor": ((0, 0, weight + P), (0, 0, 0)), "ceiling": ((0, 0, -P), (0, 0, 1))}
    return resultants(model, forces).ravel()


def pressing(model, result):
    """P/W of a result."""
    ceiling = [interface.name for interface in model.interfaces].index("ceiling|block")
    return -result.stress_resultants[ceiling, 2] / model.free_blocks[0].weight


def resultants(model, forces):
    """(V1, V2, N, M1, M2, T) of each interface from the force on the block and where it acts."""
    Q = []
    for interface in model.interfaces:
        ((force, point),) = (forces[name] for name in forces if name in interface.name)
        sign = 1.0 if interface.block_j == "block" else -1.0  # Q acts on block i, from block j
        moment = np.cross(np.array(point) - interface.centroid, force)
        Q.append(-sign * np.r_[interface.axes @ force, interface.axes @ moment])
    return np.array(Q)


def picture(folder, model, claims, started):
    import matplotlib.pyplot as plt

    plt.style.use("limitblocks.plots.paper")
    figure, axes = plt.subplots(1, 3, figsize=(7, 2.4), width_ratios=(1.1, 1, 1))
    press = np.linspace(0, 2, 50)
    axes[0].plot(press, FRICTION * (1 + 2 * press), color="0.6", label="mu (1 + 2 P/W): all solve")
    axes[0].plot(PRESSES, [one.load_factor for one in claims], "o", color="#D55E00", label="claimed by hand")
    ends = [(pressing(model, found), found.load_factor) for found in started]
    axes[0].plot(*zip(*ends, strict=True), "kx", markersize=10, label="found")
    axes[0].set(xlabel="force of the ceiling, P/W", ylabel="load factor", ylim=(0, 2.4))
    axes[0].legend(loc="upper left")
    for ax, one in zip(axes[1:], started, strict=True):
        lb.plots.forces(model, one, ax=ax)
        ax.set_title(f"load factor {one.load_factor:.3f}")
    folder.mkdir(parents=True, exist_ok=True)
    figure.savefig(folder / "15_two_right_answers.png")
    plt.close(figure)


if __name__ == "__main__":
    main()
