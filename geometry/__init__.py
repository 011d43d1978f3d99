"""The wheel as numbers, its mesh of hexahedra, the checks of that mesh and its files."""

from geometry.build import build_mesh
from geometry.checks import check_matches_design, check_mesh
from geometry.closed_form import closed_form_joint_areas, closed_form_volume, part_masses
from geometry.inp import write_inp
from geometry.measures import MeshQuality, joint_areas, mesh_quality, mesh_volume
from geometry.msh import write_msh
from geometry.parts import Cone, Grousers, HubRing, SpringSet, Tire
from geometry.planar import build_planar_mesh
from geometry.spline_surface import SplineSurface, bezier_surface
from geometry.step import write_step
from geometry.step_surfaces import read_surfaces_step
from geometry.summary import MeshSummary, PartSummary, summarize_mesh
from geometry.surface_step import step_points, write_surfaces_step
from geometry.vtu import write_vtu
from geometry.wheel import WheelDesign, exomars

__all__ = [
    "Cone",
    "Grousers",
    "HubRing",
    "MeshQuality",
    "MeshSummary",
    "PartSummary",
    "SplineSurface",
    "SpringSet",
    "Tire",
    "WheelDesign",
    "bezier_surface",
    "build_mesh",
    "build_planar_mesh",
    "check_matches_design",
    "check_mesh",
    "closed_form_joint_areas",
    "closed_form_volume",
    "exomars",
    "joint_areas",
    "mesh_quality",
    "mesh_volume",
    "part_masses",
    "read_surfaces_step",
    "step_points",
    "summarize_mesh",
    "write_inp",
    "write_msh",
    "write_step",
    "write_surfaces_step",
    "write_vtu",
]
