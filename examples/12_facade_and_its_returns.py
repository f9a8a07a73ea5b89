"""How much does a facade gain from stones that interlock with its return walls?

A facade of five courses, 4 m x 2 m, of stones 0.8 m x 0.4 m x 0.4 m, is pushed outwards by a share alpha of
its weight. By itself, t thick and H high, it turns about its lower edge and stands as long as

    alpha <= t/H

With return walls whose quoins alternate with its own it has to take stones of them along: friction under
these holds it back, more the higher the wall is above them. That cannot help without limit. All may slide
on the base, and if all stones were glued together, facade and returns would turn as one body about the toe
of the facade. Both are mechanisms, and upper bounds:

    alpha <= min(mu, sum of W y / sum of W z),    y behind the toe, z above the base

These are bounds, which assume that stones lift as they slide (associated flow): to slide off its course a
quoin then lifts what lies on it. Dry stone slides without lifting, and the gain is smaller. It is the
second curve that tells what interlocking is worth; lesson 23 has more structures.

Source: Giuffrè (1991), Letture sulla meccanica delle murature storiche, and D'Ayala & Speranza (2003),
Earthquake Spectra 19, for the mechanisms; both formulas are moments about the toe.
"""

from pathlib import Path

import numpy as np

import limitblocks as lb

LENGTH, COURSES, RETURN, THICKNESS, HEIGHT = 4.0, 5, 1.6, 0.4, 2.0
FRICTIONS = (0.3, 0.6, 0.8)


def main(folder="output"):
    alone = lb.structures.wall(
        lb.OrdunaLourenco(friction=0.6),
        length=LENGTH,
        courses=COURSES,
        block_length=0.8,
        block_height=0.4,
        thickness=THICKNESS,
        direction=(0, -1, 0),
    )
    free = lb.bounds(alone)
    lifted = {friction: lb.bounds(facade(friction)).lower for friction in FRICTIONS}
    tied = {friction: lb.nonassociated(facade(friction)) for friction in FRICTIONS}
    print(f"free-standing: {free.lower:.4f}, t/H = {THICKNESS / HEIGHT:.4f}")
    for friction, found in tied.items():
        gain, bound = found.load_factor / free.lower, lifted[friction]
        print(
            f"interlocked, friction {friction}: {found.load_factor:.4f}, {gain:.2f} times; "
            f"if sliding lifted {bound:.4f}, {bound / free.lower:.2f} times"
        )
    one_body = glued(facade(0.6))
    print(f"as one body: {one_body:.4f}")
    for friction, found in tied.items():
        assert free.lower < found.load_factor < lifted[friction] + 1e-6
        assert lifted[friction] < min(friction, one_body) + 1e-6
    picture(Path(folder), alone, free, tied, lifted, one_body)
    return {"free-standing": free.lower, "friction 0.3": lifted[0.3], "one body": one_body}


def facade(friction):
    return lb.structures.facade(
        lb.OrdunaLourenco(friction), length=LENGTH, courses=COURSES, return_length=RETURN, openings=()
    )


def glued(model):
    """Load factor of all free blocks as one body about the toe of the facade, y = z = 0."""
    weights = np.array([block.weight for block in model.free_blocks])
    centroids = np.array([block.centroid for block in model.free_blocks])
    return (weights @ centroids[:, 1]) / (weights @ centroids[:, 2])


def picture(folder, alone, free, tied, lifted, one_body):
    import matplotlib.pyplot as plt

    plt.style.use("limitblocks.plots.paper")
    figure = plt.figure(figsize=(7, 2.8))
    left = figure.add_subplot(1, 3, 1)
    values = [found.load_factor for found in tied.values()]
    left.plot(list(tied), values, "o-", color="#0072B2", label="interlocked")
    left.plot(list(lifted), list(lifted.values()), "s--", color="#E69F00", label="if sliding lifted")
    left.axhline(free.lower, color="#D55E00", label="free-standing, t/H")
    left.plot([0.3, one_body, 0.8], [0.3, one_body, one_body], ":", color="0.6", label="slides, or one body")
    left.set(xlabel="friction", ylabel="load factor", ylim=(0, None), title="A facade pushed outwards")
    left.legend(loc="lower right")
    cases = (
        (alone, free, f"free-standing: {free.lower:.3f}"),
        (facade(0.6), tied[0.6], f"interlocked, friction 0.6: {tied[0.6].load_factor:.3f}"),
    )
    for k, (model, found, word) in enumerate(cases):
        ax = figure.add_subplot(1, 3, k + 2, projection="3d", proj_type="ortho", elev=22, azim=-50)
        lb.plots.mechanism(model, found, ax=ax)
        ax.set_title(word, y=1.08)
    folder.mkdir(parents=True, exist_ok=True)
    figure.savefig(folder / "12_facade_and_its_returns.png")
    plt.close(figure)


if __name__ == "__main__":
    main()
