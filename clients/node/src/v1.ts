/** The messages of the API. */
export * from "./gen/axisgate/v1/access_pb.js";
export * from "./gen/axisgate/v1/common_pb.js";
export * from "./gen/axisgate/v1/command_pb.js";
export * from "./gen/axisgate/v1/control_pb.js";
export * from "./gen/axisgate/v1/device_pb.js";
export * from "./gen/axisgate/v1/event_pb.js";
export * from "./gen/axisgate/v1/mill_pb.js";
export * from "./gen/axisgate/v1/motion_pb.js";
export * from "./gen/axisgate/v1/position_pb.js";
export * from "./gen/axisgate/v1/settings_pb.js";
export * from "./gen/axisgate/v1/stage_pb.js";
