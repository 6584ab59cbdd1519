"""Solids read back from STEP weigh what their plates do."""

from pathlib import Path

import pytest

from fes_mj.linkage.plates import Hole, Plate


@pytest.mark.long
@pytest.mark.parametrize("third", [None, 0.05 + 0.1j, 0.05 - 0.1j])
def test_volume_and_centre_of_mass(third: complex | None, tmp_path: Path) -> None:
    """By the kernel's own integration."""
    pytest.importorskip("OCP")
    from OCP.BRepGProp import BRepGProp
    from OCP.GProp import GProp_GProps
    from OCP.STEPControl import STEPControl_Reader

    from fes_mj.drawing.solid import step_text

    holes = [Hole("a", 0j, 0.01), Hole("b", 0.25 + 0j, 0.014), *([Hole("c", third, 0.02)] if third else [])]
    plate = Plate("coupler", tuple(holes), 0.03, 0.01)
    text = step_text(plate)
    assert text == step_text(plate)
    (tmp_path / "coupler.step").write_text(text)
    reader = STEPControl_Reader()
    reader.ReadFile(str(tmp_path / "coupler.step"))
    reader.TransferRoots()
    properties = GProp_GProps()
    BRepGProp.VolumeProperties_s(reader.OneShape(), properties)
    inertia = plate.inertia(1.0)
    assert 1e-9 * properties.Mass() == pytest.approx(inertia.mass, rel=1e-6)
    centre = properties.CentreOfMass()
    assert 1e-3 * complex(centre.X(), -centre.Y()) == pytest.approx(inertia.centre, abs=1e-8)
