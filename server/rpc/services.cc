#include "server/rpc/services.h"

#include <google/protobuf/descriptor.h>

namespace axisgate::rpc {
namespace {

void add_methods(std::string_view service, std::vector<ServedMethod>& methods) {
  const google::protobuf::ServiceDescriptor& descriptor =
      *google::protobuf::DescriptorPool::generated_pool()->FindServiceByName(std::string(service));
  for (int i = 0; i < descriptor.method_count(); ++i) {
    const google::protobuf::MethodDescriptor& method = *descriptor.method(i);
    const bool streams = method.client_streaming() || method.server_streaming();
    methods.push_back({descriptor.full_name() + "/" + method.name(), streams});
  }
}

}  // namespace

std::vector<ServedMethod> served_methods() {
  std::vector<ServedMethod> methods;
  for (const std::string_view service : kApiServices) add_methods(service, methods);
  for (const std::string_view service : kCommonServices) add_methods(service, methods);
  return methods;
}

}  // namespace axisgate::rpc
