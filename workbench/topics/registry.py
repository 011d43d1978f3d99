"""The topics of the report, in the order of its page. Verified by tests/unit/test_workbench_topics.py."""

from __future__ import annotations

from workbench.study.model import Study
from workbench.topics.ancf_dynamics import ANCF_DYNAMICS
from workbench.topics.ancf_fit import ANCF_FIT
from workbench.topics.ancf_mesh import ANCF_MESH
from workbench.topics.contact import CONTACT
from workbench.topics.environment import ENVIRONMENT
from workbench.topics.hub import HUB
from workbench.topics.mesh_study import MESH_STUDY
from workbench.topics.multibody import MULTIBODY
from workbench.topics.orientations import ORIENTATIONS
from workbench.topics.rover import ROVER
from workbench.topics.rover_ancf import ROVER_ANCF
from workbench.topics.rover_closer import ROVER_CLOSER
from workbench.topics.rover_crosscheck import ROVER_CROSSCHECK
from workbench.topics.rover_mission import ROVER_MISSION
from workbench.topics.section import SECTION
from workbench.topics.speed import SPEED
from workbench.topics.strength import STRENGTH
from workbench.topics.topic import Topic
from workbench.topics.verification import VERIFICATION

__all__ = ["TOPICS", "topics_of"]

TOPICS: tuple[Topic, ...] = (
    ORIENTATIONS,
    MESH_STUDY,
    CONTACT,
    SECTION,
    HUB,
    STRENGTH,
    ENVIRONMENT,
    ANCF_FIT,
    ANCF_MESH,
    ANCF_DYNAMICS,
    MULTIBODY,
    ROVER,
    ROVER_ANCF,
    ROVER_CROSSCHECK,
    ROVER_MISSION,
    ROVER_CLOSER,
    VERIFICATION,
    SPEED,
)


def topics_of(study: Study) -> tuple[Topic, ...]:
    """Those that apply to a study."""
    return tuple(topic for topic in TOPICS if topic.applies(study))
