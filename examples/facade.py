"""Facade with a window and two return walls, pushed out of plane: how strong, and how does it fail?

The facade is 4.8 m x 2 m, of stones 0.8 m x 0.4 m x 0.4 m in running bond; its quoins alternate with those
of the return walls. The load factor is the horizontal acceleration, over g, at which it collapses outwards.

Two numbers, and why: if sliding lifted the stones by the friction angle the load factor would lie between
the two bounds, which agree. Dry stone slides without lifting. The load factor to design with is that of
the non-associated analysis: equilibrium, friction and mechanism are put into Eqs (54)-(59) again, and what
is left of each is printed. It is at most the bound.

The facade of 160 blocks, `lb.structures.facade(joint)`, has the same shape, and takes half a minute.
"""

from pathlib import Path

import limitblocks as lb


def main(folder="output"):
    output = Path(folder)
    output.mkdir(parents=True, exist_ok=True)
    joint = lb.OrdunaLourenco(friction=0.6)
    model = lb.structures.facade(
        joint, length=4.8, courses=5, return_length=1.6, openings=[(2.0, 0.4, 0.8, 0.8)]
    )
    print(f"{model}; saved to {model.save(output / 'facade.json', overwrite=True)}")
    print("bounds, with sliding that lifts ...", flush=True)
    bounds = lb.bounds(model)
    print("the same without lift ...", flush=True)
    result = lb.nonassociated(model)
    check = lb.check_mcp(model, result)
    check.require()
    report = lb.report(model, result, bounds, check)
    print(f"report: {report.save(output / 'facade.html', overwrite=True)}\n")
    worst = check.worst
    print(f"collapse at      {result.load_factor:.6f} g, certified: residuals at most {worst.value:.0e}")
    print(f"if sliding lifts {bounds.lower:.6f} g to {bounds.upper:.6f} g, the associated bounds")
    print(f"a free wall      {0.4 / 2.0:.6f} g, thickness over height: the return walls hold it")
    return {"load factor": result.load_factor, "bound": bounds.upper}


if __name__ == "__main__":
    main()
