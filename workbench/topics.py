"""The topics of the report, in the order of its page. Verified by tests/unit/test_workbench_topics.py."""

from __future__ import annotations

from workbench.study import Study
from workbench.topic import Topic
from workbench.topic_ancf_dynamics import ANCF_DYNAMICS
from workbench.topic_ancf_fit import ANCF_FIT
from workbench.topic_ancf_mesh import ANCF_MESH
from workbench.topic_contact import CONTACT
from workbench.topic_environment import ENVIRONMENT
from workbench.topic_hub import HUB
from workbench.topic_mesh_study import MESH_STUDY
from workbench.topic_multibody import MULTIBODY
from workbench.topic_orientations import ORIENTATIONS
from workbench.topic_rover import ROVER
from workbench.topic_rover_ancf import ROVER_ANCF
from workbench.topic_rover_closer import ROVER_CLOSER
from workbench.topic_rover_crosscheck import ROVER_CROSSCHECK
from workbench.topic_section import SECTION
from workbench.topic_speed import SPEED
from workbench.topic_strength import STRENGTH
from workbench.topic_verification import VERIFICATION

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
    ROVER_CLOSER,
    VERIFICATION,
    SPEED,
)


def topics_of(study: Study) -> tuple[Topic, ...]:
    """Those that apply to a study."""
    return tuple(topic for topic in TOPICS if topic.applies(study))
