// A daemon with a simulated mill beside the stage, and what its callers ask.
#pragma once

#include <gmock/gmock.h>

#include <filesystem>
#include <memory>
#include <string>

#include "axisgate/v1/mill.grpc.pb.h"
#include "tests/integration/rpc_fixture.h"
#include "tests/paths/paths.h"

namespace axisgate::rpc {

inline constexpr const char* kMill = "devices/mill";
// Half a second each, above the workpiece. A mill's time is the gateway's: a faster simulator does not shorten it.
inline std::string vectors(int count) {
  std::string job = "PA;VS15;";
  for (int i = 0; i < count; ++i) job += i % 2 == 0 ? "PU400,400;" : "PU0,400;";
  return job + "PU0,0;!MC0;";
}

class RpcMill : public RpcTest {
 protected:
  void SetUp() override {
    spool_ = *server::spool::Spool::open(directory_ + ".spool", {});
    RpcTest::SetUp();
    stub_ = v1::MillService::NewStub(channel_);
    watch_until([](const v1::Mill& mill) { return mill.line_open(); });
  }
  void TearDown() override {
    RpcTest::TearDown();
    spool_.reset();
    std::filesystem::remove_all(directory_ + ".spool");
  }
  void configure(server::Config& config) override {
    const auto read = server::parse_config("[[device]]\nname = \"mill\"\nkind = \"rml1\"\nprofile = \"" +
                                               paths::in_project("deploy/mills/mdx-20.toml").string() +
                                               "\"\nconnection = \"simulated\"\nspeed = 20\ntools = [\"T1\", \"T2\"]\n",
                                           "test.toml", server::device_kinds());
    ASSERT_TRUE(read) << to_string(read.error().front());
    config.devices.push_back(read->devices.front());
    std::get<server::MillConfig>(config.devices.back().family).station = {station_};
  }

  // Sends the header and the pieces, one message each.
  grpc::Status upload(const v1::JobHeader& header, const std::vector<std::string>& pieces, v1::Job* sent = nullptr) {
    grpc::ClientContext context;
    limit(context);
    v1::SendJobResponse response;
    const auto writer = stub_->SendJob(&context, &response);
    v1::SendJobRequest message;
    *message.mutable_header() = header;
    writer->Write(message);
    for (const std::string& piece : pieces) {
      message.set_data(piece);
      writer->Write(message);
    }
    writer->WritesDone();
    const grpc::Status status = writer->Finish();
    if (sent != nullptr) *sent = response.job();
    return status;
  }
  static v1::JobHeader header_of(const std::string& id, const std::string& title = "part.rml") {
    v1::JobHeader header;
    header.mutable_context()->set_request_id(id);
    header.set_device(kMill);
    header.set_title(title);
    header.set_tool("T1");
    return header;
  }
  grpc::Status send(const std::string& job, v1::Job* sent = nullptr, const std::string& tool = "T1",
                    const std::string& id = "", v1::Streaming streaming = v1::STREAMING_UNSPECIFIED) {
    v1::JobHeader header = header_of(id);
    header.set_tool(tool);
    header.set_streaming(streaming);
    const std::size_t half = job.size() / 2;
    return upload(header, {job.substr(0, half), job.substr(half)}, sent);
  }
  // One upload with an id of its own, in messages of so many bytes.
  grpc::Status send_in_pieces(const std::string& job, std::size_t piece, const std::string& title, v1::Job* sent) {
    std::vector<std::string> pieces;
    for (std::size_t at = 0; at < job.size(); at += piece) pieces.push_back(job.substr(at, piece));
    return upload(header_of("pieces-1", title), pieces, sent);
  }
  // Each is a tool and its bytes; `more` bytes come, or fewer.
  using Parts = std::vector<std::pair<std::string, std::string>>;
  grpc::Status send_parts(const Parts& parts, v1::Job* sent = nullptr, int more = 0, const std::string& tool = "") {
    v1::JobHeader header = header_of("parts-1");
    header.set_tool(tool);
    std::string bytes;
    for (const auto& [name, job] : parts) {
      v1::JobPart& part = *header.add_parts();
      part.set_tool(name);
      part.set_bytes(static_cast<std::int64_t>(job.size()));
      bytes += job;
    }
    bytes.resize(bytes.size() + static_cast<std::size_t>(more), ';');
    return upload(header, {bytes}, sent);
  }
  v1::Job sent(const std::string& job, const std::string& id = "") {
    v1::Job made;
    const grpc::Status status = send(job, &made, "T1", id);
    EXPECT_TRUE(status.ok()) << status.error_message();
    return made;
  }
  template <class Request, class Response>
  grpc::Status ask(grpc::Status (v1::MillService::Stub::*method)(grpc::ClientContext*, const Request&, Response*),
                   const Request& request, Response* response = nullptr) {
    grpc::ClientContext context;
    limit(context);
    Response ignored;
    return (stub_.get()->*method)(&context, request, response == nullptr ? &ignored : response);
  }
  grpc::Status confirm(const v1::Job& job) {
    v1::ConfirmJobRequest request;
    request.set_job(job.name());
    *request.mutable_seen() = job.setup();
    return ask(&v1::MillService::Stub::ConfirmJob, request);
  }
  grpc::Status start(const v1::Job& job, v1::StartJobResponse* response = nullptr) {
    v1::StartJobRequest request;
    request.set_job(job.name());
    return ask(&v1::MillService::Stub::StartJob, request, response);
  }
  v1::Mill now() {
    v1::GetMillRequest request;
    request.set_device(kMill);
    v1::GetMillResponse response;
    EXPECT_TRUE(ask(&v1::MillService::Stub::GetMill, request, &response).ok());
    return response.mill();
  }
  template <class Condition>
  v1::Mill watch_until(Condition condition) {
    grpc::ClientContext context;
    limit(context);
    v1::WatchMillRequest request;
    request.set_device(kMill);
    const auto stream = stub_->WatchMill(&context, request);
    v1::WatchMillResponse response;
    while (stream->Read(&response)) {
      if (condition(response.mill())) break;
    }
    EXPECT_TRUE(condition(response.mill())) << "it did not come to that";
    context.TryCancel();
    return response.mill();
  }
  static auto job_is(const v1::Job& job, v1::JobState state) {
    return [name = job.name(), state](const v1::Mill& mill) {
      for (const v1::Job& one : mill.jobs()) {
        if (one.name() == name) return one.state() == state;
      }
      return false;
    };
  }
  template <class Request, class Response>
  grpc::Status on_mill(grpc::Status (v1::MillService::Stub::*method)(grpc::ClientContext*, const Request&, Response*)) {
    Request request;
    request.set_device(kMill);
    return ask(method, request);
  }

  std::string station_ = "unix";
  std::unique_ptr<v1::MillService::Stub> stub_;
};

}  // namespace axisgate::rpc
