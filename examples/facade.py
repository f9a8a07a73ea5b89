"""Facade with a door, a window and two return walls, pushed out of plane: how strong, and how does it fail?

The facade is 6.4 m x 4.4 m, of stones 0.8 m x 0.4 m x 0.4 m in running bond; its quoins alternate with
those of the return walls. The load factor is the horizontal acceleration, over g, at which it starts to
move outwards.
"""

from pathlib import Path

import limitblocks as lb


def main(folder="output"):
    output = Path(folder)
    output.mkdir(parents=True, exist_ok=True)
    print("building the facade ...", flush=True)
    model = lb.structures.facade(lb.OrdunaLourenco(friction=0.6))
    print(f"{model}; saved to {model.save(output / 'facade.json', overwrite=True)}")
    print("bounds for a push out of plane ...", flush=True)
    bounds = lb.bounds(model)
    print(bounds)
    print(f"a free wall of the same height would overturn at {0.4 / 4.4:.3f}")
    print("writing the report ...", flush=True)
    print(f"report: {lb.report(model, bounds).save(output / 'facade.html')}")
    return bounds


if __name__ == "__main__":
    main()
