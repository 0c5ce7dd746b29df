#include "server/rpc/gate/method_kinds.h"

#include <algorithm>
#include <array>
#include <utility>

namespace axisgate::rpc {
namespace {

using Kind = api::RequestKind;
using MethodKind = std::pair<std::string_view, Kind>;

constexpr std::string_view kApi = "/axisgate.v1.";

constexpr std::string_view kReflection = "/grpc.reflection.v1.ServerReflection/",
                           kReflectionServed = "/grpc.reflection.v1alpha.ServerReflection/";

// gRPC's own services, by the beginning of the method. All of their methods only read.
constexpr std::array<MethodKind, 6> kOfGrpc = {{
    {"/grpc.health.v1.Health/Watch", Kind::watch_server},
    {"/grpc.reflection.v1.ServerReflection/ServerReflectionInfo", Kind::watch_server},
    {"/grpc.reflection.v1alpha.ServerReflection/ServerReflectionInfo", Kind::watch_server},
    {"/grpc.health.v1.Health/", Kind::ask_server},
    {kReflection, Kind::ask_server},
    {kReflectionServed, Kind::ask_server},
}};

}  // namespace

Kind kind_of(std::string_view method) {
  const auto begins = [method](const MethodKind& entry) { return method.starts_with(entry.first); };
  if (!method.starts_with(kApi)) {
    const auto found = std::ranges::find_if(kOfGrpc, begins);
    return found == kOfGrpc.end() ? Kind::unlisted : found->second;
  }
  return api::kind_of(method.substr(kApi.size()));
}

std::string served_as(std::string_view method) {
  if (!method.starts_with(kReflection)) return std::string(method);
  return std::string(kReflectionServed).append(method.substr(kReflection.size()));
}

}  // namespace axisgate::rpc
