#include "tests/bench/daemon.h"

#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <stdexcept>

namespace axisgate::bench {
namespace {

std::string content(const std::string& path) {
  std::ifstream file(path);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  if (!file) throw std::runtime_error(path + " cannot be read");
  return text;
}

std::shared_ptr<grpc::ChannelCredentials> credentials(const std::string& folder) {
  if (folder.empty()) return grpc::InsecureChannelCredentials();
  return grpc::SslCredentials(
      {content(folder + "/lab.crt"), content(folder + "/anna.key"), content(folder + "/anna.crt")});
}

}  // namespace

std::shared_ptr<grpc::Channel> connect(const std::string& target, const std::string& certificates) {
  grpc::ChannelArguments arguments;
  arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
  return grpc::CreateCustomChannel(target, credentials(certificates), arguments);
}

void check(const grpc::Status& status) {
  if (status.ok()) return;
  throw std::runtime_error(
      fmt::format("the call ended with {}: {}", static_cast<int>(status.error_code()), status.error_message()));
}

std::vector<std::string> execute(v1::CommandService::Stub& commands, const std::vector<std::string>& lines) {
  v1::ExecuteRequest request;
  request.set_device(kDevice);
  for (const std::string& line : lines) request.add_lines(line);
  grpc::ClientContext context;
  const auto stream = commands.Execute(&context, request);
  std::vector<std::string> answers;
  v1::ExecuteResponse response;
  while (stream->Read(&response)) {
    if (response.has_reply()) answers.push_back(response.reply().answer());
  }
  check(stream->Finish());
  return answers;
}

std::string start_move(v1::StageService::Stub& stage, std::int64_t pulses) {
  v1::MoveRequest request;
  request.set_device(kDevice);
  request.set_relative(true);
  v1::AxisTarget& target = *request.add_targets();
  target.set_axis("1");
  target.mutable_distance()->set_pulses(pulses);
  grpc::ClientContext context;
  v1::MoveResponse response;
  check(stage.Move(&context, request, &response));
  return response.motion().name();
}

}  // namespace axisgate::bench
