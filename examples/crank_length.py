"""How does D1's power depend on the crank's length? Statics for each length, then dynamics for the best."""

from dataclasses import replace

import fes_mj

design, moments = fes_mj.load_design("d1"), fes_mj.load_moments("p1p2")
powers = {}
for millimetres in range(156, 166, 2):
    linkage = replace(design.linkage, crank=millimetres / 1000)
    try:
        powers[millimetres] = fes_mj.quasi_static(replace(design, linkage=linkage), moments).power_mean
    except fes_mj.AssemblyError as error:
        print(f"{millimetres} mm: {error}")
for millimetres, power in powers.items():
    print(f"{millimetres} mm: {power:.2f} W")

best = max(powers, key=powers.__getitem__)
result = fes_mj.Case(replace(design, linkage=replace(design.linkage, crank=best / 1000)), moments)
print(f"best: {best} mm, {result.simulation.power_mean:.2f} W in the simulation, agrees: {result.agrees}")
