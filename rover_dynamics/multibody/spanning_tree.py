"""A model's bodies as a tree of links: which joints carry it, and which close its loops.

Verified by tests/unit/test_multibody_tree.py.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rover_dynamics.multibody.body import GROUND
from rover_dynamics.multibody.joint import Joint, JointKind
from rover_dynamics.multibody.model import Coordinate, MultibodyModel
from rover_dynamics.multibody.tree_kernels import LinkKind, Tree

__all__ = ["HungBody", "JointLink", "SpanningTree", "spanning_tree"]

FloatArray = NDArray[np.float64]

_Z, _X, _Y = (0.0, 0.0, 1.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)
_CHAINS: dict[JointKind, tuple[tuple[LinkKind, tuple[float, float, float]], ...]] = {
    JointKind.FIXED: (),
    JointKind.REVOLUTE: ((LinkKind.REVOLUTE, _Z),),
    JointKind.PRISMATIC: ((LinkKind.PRISMATIC, _Z),),
    JointKind.CYLINDRICAL: ((LinkKind.PRISMATIC, _Z), (LinkKind.REVOLUTE, _Z)),
    JointKind.SPHERICAL: ((LinkKind.SPHERICAL, _Z),),
    JointKind.UNIVERSAL: ((LinkKind.REVOLUTE, _Z), (LinkKind.REVOLUTE, _X)),
    JointKind.PLANAR: ((LinkKind.PRISMATIC, _X), (LinkKind.PRISMATIC, _Y), (LinkKind.REVOLUTE, _Z)),
}
"""Links of each joint from the first body to the second; from the second to the first, reversed about turned axes."""
_SIZES = {LinkKind.REVOLUTE: (1, 1), LinkKind.PRISMATIC: (1, 1), LinkKind.SPHERICAL: (4, 3), LinkKind.FREE: (7, 6)}


@dataclass(frozen=True, slots=True, kw_only=True)
class JointLink:
    """The link that carries a joint's angle or distance."""

    joint: str
    coordinate: Coordinate
    link: int


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class HungBody:
    """A joint of the tree: it hangs the body in row ``child`` on the one in row ``parent``, -1 for the ground."""

    joint: Joint
    parent: int
    child: int


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SpanningTree:
    """The tree of a model.

    Attributes
    ----------
    tree : its arrays, for the compiled loops
    joint_links : links that are a joint's own angle or distance, in the order of the links
    hung : the joints of the tree, parents before their children
    cut : names of the joints that close loops
    """

    tree: Tree
    joint_links: tuple[JointLink, ...]
    hung: tuple[HungBody, ...]
    cut: tuple[str, ...]


@dataclass(slots=True)
class _Links:
    """Lists that grow with the tree."""

    parents: list[int]
    kinds: list[LinkKind]
    offsets: list[FloatArray]
    turns: list[FloatArray]
    axes: list[FloatArray]
    carried: dict[str, tuple[int, FloatArray, FloatArray]]
    named: list[JointLink]
    hung: list[HungBody]

    def add(self, kind: LinkKind, parent: int, offset: FloatArray, turn: FloatArray, axis: object) -> int:
        self.parents.append(parent)
        self.kinds.append(kind)
        self.offsets.append(offset)
        self.turns.append(turn)
        self.axes.append(np.array(axis, dtype=np.float64))
        return len(self.parents) - 1


def spanning_tree(model: MultibodyModel) -> SpanningTree:
    """Breadth-first from the ground, so that paths are short; bodies without a way to it get a free link each group."""
    links = _Links([], [], [], [], [], {GROUND: (-1, np.zeros(3), np.eye(3))}, [], [])
    used: set[str] = set()
    _grow(model, links, used, [GROUND])
    for body in model.bodies:
        if body.name not in links.carried:
            link = links.add(LinkKind.FREE, -1, np.zeros(3), np.eye(3), _Z)
            links.carried[body.name] = (link, np.zeros(3), np.eye(3))
            _grow(model, links, used, [body.name])
    cut = tuple(joint.name for joint in model.joints if joint.name not in used)
    return SpanningTree(tree=_arrays(model, links), joint_links=tuple(links.named), hung=tuple(links.hung), cut=cut)


def _grow(model: MultibodyModel, links: _Links, used: set[str], names: list[str]) -> None:
    while names:
        parent = names.pop(0)
        for joint in model.joints:
            if joint.name in used or parent not in (joint.first, joint.second):
                continue
            child = joint.second if joint.first == parent else joint.first
            if child not in links.carried:
                _hang(joint, parent, child, links)
                rows = (model.number(parent), model.number(child))
                links.hung.append(HungBody(joint=joint, parent=rows[0], child=rows[1]))
                used.add(joint.name)
                names.append(child)


def _hang(joint: Joint, parent: str, child: str, links: _Links) -> None:
    """Links of a joint from the parent to the child."""
    forward = parent == joint.first
    near, far = (joint.first_frame, joint.second_frame) if forward else (joint.second_frame, joint.first_frame)
    link, point, turned = links.carried[parent]
    offset, turn = point + turned @ near.position, turned @ near.rotation
    chain = _CHAINS[joint.kind]
    for kind, axis in chain if forward else chain[::-1]:
        link = links.add(kind, link, offset, turn, np.array(axis) * (1.0 if forward else -1.0))
        offset, turn = np.zeros(3), np.eye(3)
        if axis == _Z and kind is not LinkKind.SPHERICAL:
            coordinate: Coordinate = "angle" if kind is LinkKind.REVOLUTE else "distance"
            links.named.append(JointLink(joint=joint.name, coordinate=coordinate, link=link))
    rotation = turn @ far.rotation.T
    links.carried[child] = (link, offset - rotation @ far.position, rotation)


def _arrays(model: MultibodyModel, links: _Links) -> Tree:
    sizes = np.array([_SIZES[kind] for kind in links.kinds], dtype=np.int64).reshape(-1, 2)
    starts = np.vstack([np.zeros((1, 2), dtype=np.int64), np.cumsum(sizes, axis=0)])
    carried = [links.carried[body.name] for body in model.bodies]
    n = len(links.parents)
    return Tree(
        parents=np.array(links.parents, dtype=np.int64),
        kinds=np.array(links.kinds, dtype=np.int64),
        q_at=np.ascontiguousarray(starts[:, 0]),
        v_at=np.ascontiguousarray(starts[:, 1]),
        offsets=np.array(links.offsets).reshape(n, 3),
        turns=np.array(links.turns).reshape(n, 3, 3),
        axes=np.array(links.axes).reshape(n, 3),
        body_links=np.array([link for link, _, _ in carried], dtype=np.int64),
        body_points=np.array([point for _, point, _ in carried]),
        body_turns=np.array([turn for _, _, turn in carried]),
        masses=np.array([body.mass for body in model.bodies]),
        inertias=np.array([body.inertia for body in model.bodies]),
    )
