"""The questions of the report, in the order of its page. Verified by tests/unit/test_workbench_questions.py."""

from __future__ import annotations

from workbench.questions.ancf.question import ANCF
from workbench.questions.ancf_dynamics.question import ANCF_DYNAMICS
from workbench.questions.ancf_fit.question import ANCF_FIT
from workbench.questions.ancf_mesh.question import ANCF_MESH
from workbench.questions.ancf_wheel.question import ANCF_WHEEL
from workbench.questions.ancf_wheels.question import ANCF_WHEELS
from workbench.questions.contact.question import CONTACT
from workbench.questions.crosscheck.question import CROSSCHECK
from workbench.questions.environment.question import ENVIRONMENT
from workbench.questions.fe.question import FE
from workbench.questions.hub.question import HUB
from workbench.questions.input_uncertainty.question import INPUT_UNCERTAINTY
from workbench.questions.mesh_study.question import MESH_STUDY
from workbench.questions.models.question import MODELS
from workbench.questions.multibody.question import MULTIBODY
from workbench.questions.numerics.question import NUMERICS
from workbench.questions.orientations.question import ORIENTATIONS
from workbench.questions.question import Question
from workbench.questions.rover.question import ROVER
from workbench.questions.rover_ancf.question import ROVER_ANCF
from workbench.questions.rover_closer.question import ROVER_CLOSER
from workbench.questions.rover_crosscheck.question import ROVER_CROSSCHECK
from workbench.questions.rover_mission.question import ROVER_MISSION
from workbench.questions.section.question import SECTION
from workbench.questions.soil.question import SOIL
from workbench.questions.speed.question import SPEED
from workbench.questions.strength.question import STRENGTH
from workbench.questions.traverse.question import TRAVERSE
from workbench.questions.validation.question import VALIDATION
from workbench.questions.verification.question import VERIFICATION
from workbench.questions.wheel.question import WHEEL
from workbench.questions.words.question import WORDS
from workbench.study.model import Study

__all__ = ["QUESTIONS", "questions_of"]

QUESTIONS: tuple[Question, ...] = (
    MODELS,
    WORDS,
    WHEEL,
    FE,
    ORIENTATIONS,
    STRENGTH,
    MESH_STUDY,
    CONTACT,
    SECTION,
    ANCF_WHEEL,
    ANCF_WHEELS,
    INPUT_UNCERTAINTY,
    HUB,
    ENVIRONMENT,
    SOIL,
    ANCF,
    ANCF_FIT,
    ANCF_MESH,
    ANCF_DYNAMICS,
    ROVER,
    ROVER_MISSION,
    TRAVERSE,
    ROVER_ANCF,
    ROVER_CROSSCHECK,
    ROVER_CLOSER,
    VERIFICATION,
    CROSSCHECK,
    VALIDATION,
    MULTIBODY,
    SPEED,
    NUMERICS,
)


def questions_of(study: Study) -> tuple[Question, ...]:
    """Those that apply to a study."""
    return tuple(question for question in QUESTIONS if question.applies(study))
