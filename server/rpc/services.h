// The services that the daemon serves, and their methods. A new service is a file in services/, its function here, and
// its row in services.cc; a new method is a function of its service, and a row in server/api/request/request_kinds.h.
#pragma once

#include <grpcpp/impl/service_type.h>

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "server/api/api.h"
#include "server/gateway.h"
#include "server/rpc/calls/half_close.h"

namespace axisgate::rpc {

// Services use these parts, which must outlive them.
struct ServiceParts {
  server::Gateway& gateway;
  api::Api& api;
  const HalfClose& half_close;
};

std::unique_ptr<grpc::Service> access_service(const ServiceParts& parts);
std::unique_ptr<grpc::Service> command_service(const ServiceParts& parts);
std::unique_ptr<grpc::Service> control_service(const ServiceParts& parts);
std::unique_ptr<grpc::Service> device_service(const ServiceParts& parts);
std::unique_ptr<grpc::Service> diagnostics_service(const ServiceParts& parts);
std::unique_ptr<grpc::Service> event_service(const ServiceParts& parts);
std::unique_ptr<grpc::Service> health_service(const ServiceParts& parts);
std::unique_ptr<grpc::Service> history_service(const ServiceParts& parts);
std::unique_ptr<grpc::Service> mill_service(const ServiceParts& parts);
std::unique_ptr<grpc::Service> position_service(const ServiceParts& parts);
std::unique_ptr<grpc::Service> setting_service(const ServiceParts& parts);
std::unique_ptr<grpc::Service> simulator_service(const ServiceParts& parts);
std::unique_ptr<grpc::Service> stage_service(const ServiceParts& parts);

struct ServedService {
  std::string_view name;                                                        // "axisgate.v1.StageService"
  std::unique_ptr<grpc::Service> (*make)(const ServiceParts& parts) = nullptr;  // null: gRPC makes it
};
// Returns all services.
std::span<const ServedService> services();
// Reports whether a service is one of axisgate.v1.
bool is_of_api(std::string_view service);

struct ServedMethod {
  std::string name;  // "axisgate.v1.StageService/Move"
  bool streams = false;
};
// Returns the methods of all services.
std::vector<ServedMethod> served_methods();

}  // namespace axisgate::rpc
