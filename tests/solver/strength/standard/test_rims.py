"""Y_B of gears whose teeth stand on a rim, held at its inside or on a web, in the standard's root stress."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from evolvent.strength.standard.root_stress import RootLoad, standard_stress
from evolvent_meshes.errors import InputError
from evolvent_meshes.gears.form.support import Support
from evolvent_meshes.gears.form.web import Web
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair
from tests.support.paper_pairs import he


def rimmed(backup: float, is_rim: bool = True) -> RootLoad:
    """He's pair, the pinion with a rim so many tooth heights thick."""
    pair = he()
    gear: GearParameters = pair.pinion
    height = 0.5 * (gear.tip_diameter - gear.root_diameter)
    bore = gear.root_diameter - 2.0 * backup * height
    pinion = replace(gear, bore_diameter=bore, support=Support(is_rim=is_rim))
    return RootLoad(GearPair(pinion, pair.wheel, pair.centre_distance), Member.PINION, 170e3)


def test_thin_rim_raises_the_stress() -> None:
    """As thick as the teeth are high: Y_B = 1.6 ln 2.242 = 1.2918 times the stress of the same gear on a bore of this
    diameter; from 1.2 tooth heights on there is no difference."""
    thin, bored = (standard_stress(rimmed(1.0, is_rim), 2019).stress for is_rim in (True, False))
    assert thin / bored == pytest.approx(1.6 * math.log(2.242), rel=1e-12)
    thick, alike = (standard_stress(rimmed(1.3, is_rim), 2006) for is_rim in (True, False))
    assert (thick.stress, thick.rim_thickness_factor) == (alike.stress, 1.0)


def test_rims_on_webs() -> None:
    """A web of a quarter of the face below a rim as thick as the teeth are high: Y_B as of a rim alone, 1.2918 times
    the stress of the full ring; of a web as wide as the face none."""
    pair = he()
    height = 0.5 * (pair.pinion.tip_diameter - pair.pinion.root_diameter)

    def stress(web: Web | None) -> float:
        pinion = replace(pair.pinion, web=web)
        load = RootLoad(GearPair(pinion, pair.wheel, pair.centre_distance), Member.PINION, 170e3)
        return standard_stress(load, 2019).stress

    assert stress(Web(5.0, height)) / stress(None) == pytest.approx(1.6 * math.log(2.242), rel=1e-12)
    assert stress(Web(20.0, height)) == stress(None)


def test_rims_beyond_the_standard_are_refused() -> None:
    """Half a tooth height is too thin for Y_B."""
    with pytest.raises(InputError, match=r"pinion\.rim_thickness_mm: found .* mm, 0\.47 tooth heights"):
        standard_stress(rimmed(0.47), 2019)
