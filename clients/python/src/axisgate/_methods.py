"""The calls of the API that this package uses, for any form of gRPC."""

from __future__ import annotations

from typing import Any

from axisgate.v1 import (access_pb2, command_pb2, control_pb2, device_pb2, event_pb2, mill_pb2, position_pb2,
                         settings_pb2, stage_pb2)


class Method:
    """A Method is one call of the API: its path, and how requests and answers become bytes."""

    def __init__(self, file: Any, service: str, name: str) -> None:
        descriptor = file.DESCRIPTOR.services_by_name[service].methods_by_name[name]
        self.name = name
        self.path = f"/{descriptor.containing_service.full_name}/{name}"
        self.parse = getattr(file, descriptor.output_type.name).FromString


LIST_DEVICES = Method(device_pb2, "DeviceService", "ListDevices")
GET_DEVICE = Method(device_pb2, "DeviceService", "GetDevice")
WATCH_DEVICE = Method(device_pb2, "DeviceService", "WatchDevice")
CLEAR_ERRORS = Method(device_pb2, "DeviceService", "ClearErrors")

MOVE = Method(stage_pb2, "StageService", "Move")
HOME = Method(stage_pb2, "StageService", "Home")
RUN_PATH = Method(stage_pb2, "StageService", "RunPath")
SCAN = Method(stage_pb2, "StageService", "Scan")
JOG = Method(stage_pb2, "StageService", "Jog")
STOP = Method(stage_pb2, "StageService", "Stop")
EMERGENCY_STOP = Method(stage_pb2, "StageService", "EmergencyStop")
LIST_MOTIONS = Method(stage_pb2, "StageService", "ListMotions")
WATCH_MOTION = Method(stage_pb2, "StageService", "WatchMotion")
WAIT_MOTION = Method(stage_pb2, "StageService", "WaitMotion")
CANCEL_MOTION = Method(stage_pb2, "StageService", "CancelMotion")

ACQUIRE_LEASE = Method(control_pb2, "ControlService", "AcquireLease")
RENEW_LEASE = Method(control_pb2, "ControlService", "RenewLease")
RELEASE_LEASE = Method(control_pb2, "ControlService", "ReleaseLease")
HAND_OVER_LEASE = Method(control_pb2, "ControlService", "HandOverLease")
REARM = Method(control_pb2, "ControlService", "Rearm")

GET_CALLER = Method(access_pb2, "AccessService", "GetCaller")
WATCH_EVENTS = Method(event_pb2, "EventService", "Watch")
EXECUTE = Method(command_pb2, "CommandService", "Execute")

GET_SETTINGS = Method(settings_pb2, "SettingService", "GetSettings")
CHANGE_SETTINGS = Method(settings_pb2, "SettingService", "ChangeSettings")

SAVE_POSITION = Method(position_pb2, "PositionService", "SavePosition")
LIST_POSITIONS = Method(position_pb2, "PositionService", "ListPositions")
DELETE_POSITION = Method(position_pb2, "PositionService", "DeletePosition")
MOVE_TO_POSITION = Method(position_pb2, "PositionService", "MoveToPosition")

SEND_JOB_PIECE = Method(mill_pb2, "MillService", "SendJobPiece")
GET_MILL = Method(mill_pb2, "MillService", "GetMill")
WATCH_MILL = Method(mill_pb2, "MillService", "WatchMill")
CONFIRM_JOB = Method(mill_pb2, "MillService", "ConfirmJob")
START_JOB = Method(mill_pb2, "MillService", "StartJob")
PAUSE_JOB = Method(mill_pb2, "MillService", "PauseJob")
RESUME_JOB = Method(mill_pb2, "MillService", "ResumeJob")
ABORT_JOB = Method(mill_pb2, "MillService", "AbortJob")
CANCEL_JOB = Method(mill_pb2, "MillService", "CancelJob")
REPORT_JOB_DONE = Method(mill_pb2, "MillService", "ReportJobDone")
OPERATE_MILL = Method(mill_pb2, "MillService", "OperateMill")
