"""The checks once more in another form, in SI units: corner forces and corner velocities of point contacts.

Only blocks, interfaces, numbers of the claim and the names of the problem's rows and columns are used.
"""

from dataclasses import dataclass

import numpy as np

from limitblocks.problem import Mode

UP = np.array([0.0, 0.0, 1.0])


@dataclass
class Joint:
    """One interface: its corners, the forces that block i puts on block j there is minus `forces`."""

    i: str
    j: str
    axes: np.ndarray
    corners: np.ndarray  # global
    forces: np.ndarray  # (V1, V2, N) of each corner
    opening: np.ndarray  # multiplier of each corner's opening row
    sliding: np.ndarray  # (t, z1, z2) of each corner's Coulomb cone
    friction: float


def joints_of(model, claim):
    """The claim's forces and multipliers at the corners."""
    p, found = model.problem, []
    for k, face in enumerate(model.interfaces):
        rows = np.flatnonzero(p.row_interface == k)
        modes = np.array([p.row_mode[row] for row in rows])
        corners = face.centroid + face.polygon @ face.axes[:2]
        forces = claim.generalised_stresses[p.stress_interface == k].reshape(-1, 3)
        opening = claim.flow_multipliers[rows[modes == Mode.OPEN]]
        sliding = claim.flow_multipliers[rows[modes == Mode.SLIP]].reshape(-1, 3)
        friction = face.joint.friction
        found.append(
            Joint(face.block_i, face.block_j, face.axes, corners, forces, opening, sliding, friction)
        )
    return found


def imbalance(model, claim, direction):
    """For each free block: what is unbalanced, over the sum of the sizes of what acts on it."""
    joints, found = joints_of(model, claim), {}
    for block in model.free_blocks:
        arm = np.ptp(block.vertices, axis=0).max() / 2.0
        load = block.weight * (claim.load_factor * np.asarray(direction) - UP)
        force, moment, acting = load, np.zeros(3), np.linalg.norm(load)
        for joint in joints:
            sign = {joint.i: 1.0, joint.j: -1.0}.get(block.name, 0.0)
            for corner, local in zip(joint.corners, joint.forces, strict=True):
                f = sign * (joint.axes.T @ local)
                force = force + f
                moment = moment + np.cross(corner - block.centroid, f)
                acting += np.linalg.norm(f)
        found[block.name] = max(np.linalg.norm(force), np.linalg.norm(moment) / arm) / acting, acting
    return found


def least(acting, joint):
    """What acts on the lesser of the free blocks of a joint."""
    return min(acting[name][1] for name in (joint.i, joint.j) if name in acting)


def outside(model, claim, direction):
    """Largest pull, or shear beyond friction, of a corner, over what acts on the lesser block."""
    acting, worst = imbalance(model, claim, direction), 0.0
    for joint in joints_of(model, claim):
        for V1, V2, N in joint.forces:
            beyond = max(N, np.hypot(V1, V2) + joint.friction * N, 0.0)
            worst = max(worst, beyond / least(acting, joint))
    return worst


def misfit(model, claim, direction):
    """Largest velocity of a corner that no multiplier explains: its power over that of the live load."""
    acting, worst = imbalance(model, claim, direction), 0.0
    motion = {
        block.name: (block.centroid, rates[:3], rates[3:])
        for block, rates in zip(model.blocks, claim.displacement_rates, strict=True)
    }

    def velocity(name, at):
        centroid, move, turn = motion[name]
        return move + np.cross(turn, at - centroid)

    for joint in joints_of(model, claim):
        for corner, opening, (_, z1, z2) in zip(joint.corners, joint.opening, joint.sliding, strict=True):
            apart = joint.axes @ (velocity(joint.j, corner) - velocity(joint.i, corner))
            unexplained = apart - np.array([-z1, -z2, opening])  # zero dilatancy: sliding does not lift
            power = np.abs(unexplained).max() * least(acting, joint)
            worst = max(worst, power / abs(claim.load_factor))
    return worst


def sizes(model, claim, direction):
    """The three residuals under the checker's names."""
    return {
        "equilibrium": max(share for share, _ in imbalance(model, claim, direction).values()),
        "yield": outside(model, claim, direction),
        "flow": misfit(model, claim, direction),
    }
