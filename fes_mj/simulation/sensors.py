"""Sensor rows of a model read by name."""

from typing import Any

from fes_mj.common.arrays import FloatArray


class Sensors:
    """Rows of MjData.sensordata, shape (rows, size), and the model they are of."""

    def __init__(self, model: Any, rows: FloatArray) -> None:
        self._rows = rows
        self._column = {model.sensor(i).name: int(model.sensor(i).adr[0]) for i in range(model.nsensor)}
        self.names = [*self._column]
        self.joints = [model.joint(i).name for i in range(model.njnt)]

    def __getitem__(self, name: str) -> FloatArray:
        """A sensor of one number, shape (rows,)."""
        return self._rows[:, self._column[name]]

    def vector(self, name: str) -> FloatArray:
        """A sensor of three numbers, shape (rows, 3)."""
        start = self._column[name]
        return self._rows[:, start : start + 3]

    def speed(self, joint: str) -> FloatArray:
        """Speed of a joint at the time of its angle, rad/s, shape (rows - 2,): MuJoCo's lag by half a step."""
        return self.following_speed(joint)[1:]

    def following_speed(self, joint: str) -> FloatArray:
        """The same from the first row on, shape (rows - 1,)."""
        lagging = self[f"{joint}_speed"]
        return (lagging[:-1] + lagging[1:]) / 2

    def crank_moment(self) -> FloatArray:
        """Moment on the load, N m, shape (rows,): the frame brakes the crank about +y, against its turning about -y."""
        return self.vector("crank_torque")[:, 1]
