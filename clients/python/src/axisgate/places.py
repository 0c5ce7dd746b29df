"""Saved positions of a stage."""

from __future__ import annotations

from typing import Dict, Iterator

from axisgate._methods import DELETE_POSITION, LIST_POSITIONS, MOVE_TO_POSITION, SAVE_POSITION
from axisgate._session import DeviceSession
from axisgate.results import Position, Result, axis_name, decimal_of, unit_of
from axisgate.v1 import position_pb2

# Time that saving may wait for the end of a running motion.
_WAIT_S = 20.0


class Places:
    """Places are the saved positions of a stage, by name. All functions are thread safe, and raise Refused."""

    def __init__(self, session: DeviceSession) -> None:
        self._session = session

    def save(self, name: str, *, coordinates: bool = False) -> None:
        """Saves the present position. It stays the same place when coordinates are set again, or with `coordinates` the
        same coordinates."""
        kind = position_pb2.POSITION_KIND_COORDINATES if coordinates else position_pb2.POSITION_KIND_PLACE
        self._session.act(SAVE_POSITION, position_pb2.SavePositionRequest(position=self._resource(name), kind=kind),
                          _WAIT_S)

    def move_to(self, name: str) -> Result:
        """Moves all axes to a saved position, and waits for the outcome. Ctrl-C cancels the move."""
        return self._session.finish(MOVE_TO_POSITION,
                                    position_pb2.MoveToPositionRequest(position=self._resource(name)))

    def delete(self, name: str) -> None:
        """Deletes a saved position."""
        self._session.act(DELETE_POSITION, position_pb2.DeletePositionRequest(position=self._resource(name)))

    def read(self) -> Dict[str, Dict[str, Position]]:
        """Returns the saved positions by name, with the positions of the axes when they were saved."""
        listed = self._session.connection.ask(LIST_POSITIONS, position_pb2.ListPositionsRequest(
            device=self._session.device))
        return {one.name.rpartition("/")[2]: {axis_name(at.name, at.axis): Position(
            axis_name(at.name, at.axis), decimal_of(at.position), unit_of(at.unit), at.pulses)
            for at in one.coordinates} for one in listed.positions}

    def __iter__(self) -> Iterator[str]:
        """Iterates over the names."""
        return iter(self.read())

    def _resource(self, name: str) -> str:
        return f"{self._session.device}/positions/{name}"
