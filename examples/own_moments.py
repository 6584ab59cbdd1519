"""Joint moments from an array instead of a file: a knee that only extends, with 20 N m, and no hip at all."""

import numpy as np

import fes_mj

crank_angle = np.radians(np.arange(0.0, 360.0, 1.0))  # from top dead centre; the first half turn extends the knee
moments = fes_mj.JointMoments("knee only", crank_angle, np.where(crank_angle < np.pi, 20.0, 0.0), 0 * crank_angle)

for name in ("trt", "d1"):
    static = fes_mj.quasi_static(fes_mj.load_design(name), moments)
    swing = np.ptp(static.joint_angle.knee)
    print(f"{name}: {static.work_per_turn:.2f} J per turn; 20 N m over the knee's swing are {20 * swing:.2f} J")
