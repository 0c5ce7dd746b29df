// The whole API of the gateway, connected. A door receives the Api, or the subjects that it needs.
#pragma once

#include "server/access/access.h"
#include "server/api/looking/devices.h"
#include "server/api/looking/diagnostics.h"
#include "server/api/looking/events.h"
#include "server/api/looking/history.h"
#include "server/api/looking/simulators.h"
#include "server/api/mill/mill_subjects.h"
#include "server/api/request/admission.h"
#include "server/api/request/pipeline.h"
#include "server/api/request/streams.h"
#include "server/api/sharing/leases.h"
#include "server/api/sharing/tokens.h"
#include "server/api/stage/commands.h"
#include "server/api/stage/jogs.h"
#include "server/api/stage/motions.h"
#include "server/api/stage/paths.h"
#include "server/api/stage/positions.h"
#include "server/api/stage/settings.h"
#include "server/api/stage/stops.h"
#include "server/devices/saved_positions.h"
#include "server/gateway.h"

namespace axisgate::api {

// Thread safe. Requests in progress do not keep the Api alive, but each device may answer until the gateway ends.
class Api {
 public:
  // `gateway` must outlive this object; `access` and `saved_positions` must outlive the gateway.
  Api(server::Gateway& gateway, const server::Access& access, server::SavedPositions& saved_positions)
      : admission(access, gateway.config().limits, gateway.lease_tokens()),
        mutations(gateway),
        pipeline(admission, mutations),
        mill_pipeline(admission, mutations),
        device_pipeline(admission, mutations),
        stops(gateway, admission),
        motions(gateway, pipeline, streams),
        paths(gateway, pipeline, streams),
        jogs(gateway, pipeline, streams),
        leases(gateway, admission, device_pipeline, streams),
        settings(gateway, access, pipeline),
        positions(gateway, pipeline, saved_positions),
        commands(gateway, access, pipeline, streams),
        devices(gateway, admission, pipeline, streams),
        events(gateway, admission, streams),
        history(gateway, admission),
        diagnostics(gateway, admission, device_pipeline, streams),
        simulators(gateway, device_pipeline),
        tokens(gateway, access, admission, streams),
        mill(gateway, mill_pipeline, streams) {}

  Admission admission;
  Streams streams;
  const Mutations mutations;
  const Pipeline pipeline;
  const MillPipeline mill_pipeline;
  const DevicePipeline device_pipeline;
  const Stops stops;
  const Motions motions;
  const Paths paths;
  const Jogs jogs;
  const Leases leases;
  const Settings settings;
  const Positions positions;
  const Commands commands;
  const Devices devices;
  const Events events;
  const History history;
  const Diagnostics diagnostics;
  const Simulators simulators;
  const Tokens tokens;
  const MillSubjects mill;
};

}  // namespace axisgate::api
