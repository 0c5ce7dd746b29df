// Tests of access: every method, every role and every kind of credential, over the Unix socket, loopback and TLS.
#include <gmock/gmock.h>
#include <google/protobuf/descriptor.h>

#include <fstream>
#include <iterator>
#include <map>
#include <set>

#include "server/rpc/services.h"
#include "tests/certificates/authority.h"
#include "tests/integration/rpc_fixture.h"

namespace axisgate::rpc {
namespace {

using server::Role;

// Methods by their least role, typed by hand. kOperator also has the methods that
// `admin_commands` restricts to administrators.
const std::set<std::string> kObserver = {"AccessService/GetCaller",
                                         "CommandService/ListCommands",
                                         "ControlService/WatchLeases",
                                         "DeviceService/ListDevices",
                                         "DeviceService/GetDevice",
                                         "DeviceService/WatchDevice",
                                         "DiagnosticsService/Record",
                                         "DiagnosticsService/GetSupportReport",
                                         "EventService/Watch",
                                         "HistoryService/ListHistory",
                                         "HistoryService/SummarizeHistory",
                                         "HistoryService/VerifyJournal",
                                         "StageService/Stop",
                                         "StageService/EmergencyStop",
                                         "StageService/GetMotion",
                                         "StageService/ListMotions",
                                         "StageService/WatchMotion",
                                         "StageService/WaitMotion",
                                         "SettingService/GetSettings",
                                         "PositionService/ListPositions",
                                         "MillService/GetMill",
                                         "MillService/WatchMill",
                                         "MillService/AbortJob"};
const std::set<std::string> kOperator = {"CommandService/Execute",
                                         "ControlService/AcquireLease",
                                         "ControlService/KeepLeaseAlive",
                                         "ControlService/RenewLease",
                                         "ControlService/ReleaseLease",
                                         "ControlService/HandOverLease",
                                         "ControlService/Rearm",
                                         "SettingService/ChangeSettings",
                                         "SettingService/SetCoordinates",
                                         "SettingService/FireTrigger",
                                         "SimulatorService/Operate",
                                         "StageService/Move",
                                         "StageService/Home",
                                         "StageService/ReturnToOrigin",
                                         "StageService/RunPath",
                                         "StageService/StartPath",
                                         "StageService/Scan",
                                         "StageService/Jog",
                                         "StageService/StartJog",
                                         "StageService/KeepJog",
                                         "StageService/StopJog",
                                         "StageService/CancelMotion",
                                         "PositionService/SavePosition",
                                         "PositionService/DeletePosition",
                                         "PositionService/MoveToPosition",
                                         "MillService/SendJob",
                                         "MillService/SendJobPiece",
                                         "MillService/RepeatJob",
                                         "MillService/ConfirmJob",
                                         "MillService/StartJob",
                                         "MillService/PauseJob",
                                         "MillService/ResumeJob",
                                         "MillService/ContinueJob",
                                         "MillService/CancelJob",
                                         "MillService/MoveJob",
                                         "MillService/ReportJobDone",
                                         "MillService/OperateMill"};
const std::set<std::string> kAdmin = {
    "AccessService/CreateToken",    "AccessService/ListTokens",   "AccessService/RevokeToken",
    "ControlService/TakeOverLease", "DeviceService/ClearErrors",  "DeviceService/WithdrawStop",
    "SettingService/ResetDevice",   "HistoryService/ErasePerson", "MillService/CancelJobs"};

Role needed(const std::string& method) {
  return kObserver.contains(method) ? Role::observer : kOperator.contains(method) ? Role::operator_ : Role::admin;
}

std::vector<std::string> methods() {
  std::vector<std::string> all;
  for (const ServedService& service : services()) {
    if (!is_of_api(service.name)) continue;
    const auto* descriptor =
        google::protobuf::DescriptorPool::generated_pool()->FindServiceByName(std::string(service.name));
    for (int i = 0; i < descriptor->method_count(); ++i) {
      all.push_back(descriptor->name() + "/" + descriptor->method(i)->name());
    }
  }
  return all;
}

class RpcAccess : public RpcTest {
 protected:
  void SetUp() override {
    std::filesystem::create_directory(certificates_);
    const Authority lab(certificates_, "lab");
    for (const char* name : {"gateway", "anna", "guest", "expired"}) lab.issue(name);
    lab.issue("expired", std::chrono::hours(-1));
    Authority(certificates_, "elsewhere").issue("mallory");
    RpcTest::SetUp();
  }
  void TearDown() override {
    RpcTest::TearDown();
    std::filesystem::remove_all(certificates_);
  }
  void configure(server::Config& config) override {
    config.network = {.listen = {"127.0.0.1", 0},
                      .certificate = certificates_ + "/gateway.crt",
                      .key = certificates_ + "/gateway.key",
                      .client_ca = certificates_ + "/lab.crt"};
    config.access.roles["cert guest"] = Role::observer;
  }

  static std::string content(const std::string& path) {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  // With the certificate of `caller`; empty: without one.
  std::shared_ptr<grpc::Channel> tls(const std::string& caller) {
    grpc::SslCredentialsOptions options;
    options.pem_root_certs = content(certificates_ + "/lab.crt");
    if (!caller.empty()) {
      options.pem_private_key = content(certificates_ + "/" + caller + ".key");
      options.pem_cert_chain = content(certificates_ + "/" + caller + ".crt");
    }
    return grpc::CreateChannel(to_string(*doors_->network()), grpc::SslCredentials(options));
  }

  static server::Calendar now() { return server::calendar_now(); }

  // A token of that role; `kind` is "right", "expired" or "revoked".
  std::string token(Role role, const std::string& kind) {
    const std::string called = kind + "-" + std::string(name(role));
    const auto hours = std::chrono::hours(1);
    const auto made = kind == "expired" ? access_->tokens().create(called, role, now() - hours, now() - 2 * hours)
                                        : access_->tokens().create(called, role, now() + hours, now());
    EXPECT_TRUE(made) << made.error().message;
    if (kind == "revoked") {
      EXPECT_TRUE(access_->tokens().revoke(called, now()));
    }
    return made.value_or("");
  }

  // An empty request, cancelled where it is let in and never ends.
  static grpc::Status ask(const std::shared_ptr<grpc::Channel>& channel, const std::string& method,
                          const std::string& authorization, bool let_in) {
    grpc::ClientContext context;
    context.set_deadline(server::to_wall(monotonic_now() + std::chrono::seconds(let_in ? 1 : 30)));
    if (!authorization.empty()) context.AddMetadata("authorization", authorization);
    return call(channel, "/axisgate.v1." + method, context);
  }

  void expect(const std::shared_ptr<grpc::Channel>& channel, Role role, const std::string& authorization,
              const std::string& what) {
    for (const std::string& method : methods()) {
      const bool let_in = role >= needed(method);
      const grpc::Status status = ask(channel, method, authorization, let_in);
      const grpc::StatusCode code = status.error_code();
      if (let_in) {
        EXPECT_TRUE(code != grpc::UNAUTHENTICATED && code != grpc::PERMISSION_DENIED)
            << method << " " << what << ": " << status.error_message();
      } else {
        EXPECT_EQ(code, role == Role::nobody ? grpc::UNAUTHENTICATED : grpc::PERMISSION_DENIED)
            << method << " " << what << ": " << status.error_message();
      }
    }
  }

  std::shared_ptr<grpc::Channel> loopback() {
    return grpc::CreateChannel(to_string(doors_->listen()), grpc::InsecureChannelCredentials());
  }

  std::string who(const std::shared_ptr<grpc::Channel>& channel, const std::string& authorization) {
    grpc::ClientContext context;
    limit(context);
    if (!authorization.empty()) context.AddMetadata("authorization", authorization);
    v1::GetCallerResponse caller;
    const auto stub = v1::AccessService::NewStub(channel);
    const grpc::Status status = stub->GetCaller(&context, {}, &caller);
    return status.ok() ? caller.caller().name() + ", " + v1::Role_Name(caller.role()) : status.error_message();
  }

  const std::string certificates_ = directory_ + ".certificates";
};

TEST_F(RpcAccess, EveryMethodHasARole) {
  for (const std::string& method : methods()) {
    EXPECT_TRUE(kObserver.contains(method) || kOperator.contains(method) || kAdmin.contains(method)) << method;
  }
}

TEST_F(RpcAccess, WithoutAToken) {
  expect(channel_, Role::admin, "", "as the user as whom the daemon runs");
  expect(loopback(), Role::operator_, "", "over loopback");
  expect(tls(""), Role::nobody, "", "over the network");
  expect(tls("anna"), Role::operator_, "", "with a certificate");
  expect(tls("guest"), Role::observer, "", "with a certificate that the configuration names");
}

// gRPC drops such a connection in its handshake.
TEST_F(RpcAccess, ACertificateOfAnotherAuthorityOrAnExpiredOneOrNoTlsIsNoWayIn) {
  const auto plain = grpc::CreateChannel(to_string(*doors_->network()), grpc::InsecureChannelCredentials());
  for (const auto& channel : {tls("mallory"), tls("expired"), plain}) {
    const grpc::Status status = call(channel, "/axisgate.v1.AccessService/GetCaller");
    EXPECT_EQ(status.error_code(), grpc::UNAVAILABLE) << status.error_message();
  }
}

TEST_F(RpcAccess, ATokenGoesBeforeTheUser) {
  for (const Role role : {Role::observer, Role::operator_, Role::admin}) {
    for (const std::string kind : {"right", "expired", "revoked"}) {
      const std::string secret = token(role, kind);
      for (const auto& channel : {channel_, loopback(), tls(""), tls("guest")}) {
        expect(channel, kind == "right" ? role : Role::nobody, "Bearer " + secret, kind);
      }
    }
  }
}

TEST_F(RpcAccess, ABadTokenIsRefusedWhereNoneWouldDo) {
  const std::string good = token(Role::admin, "right");
  std::string wrong = good;
  wrong.back() = wrong.back() == '0' ? '1' : '0';
  for (const std::string& bad : {"Bearer " + wrong, "Bearer " + good.substr(0, good.size() - 1), std::string("Bearer "),
                                 std::string("Basic YTpi"), good, "bearer" + good}) {
    expect(channel_, Role::nobody, bad, bad);
    expect(tls("anna"), Role::nobody, bad, bad);
  }
  EXPECT_EQ(who(channel_, "Bearer " + good), "token right-admin, ROLE_ADMIN");
  EXPECT_EQ(who(channel_, "bearer " + good), "token right-admin, ROLE_ADMIN");
}

TEST_F(RpcAccess, WhoCalls) {
  EXPECT_EQ(who(channel_, ""), server::caller_name(::geteuid()) + ", ROLE_ADMIN");
  EXPECT_EQ(who(loopback(), "").substr(0, 14), "tcp 127.0.0.1:");
  EXPECT_EQ(who(tls("anna"), ""), "cert anna, ROLE_OPERATOR");
  EXPECT_EQ(who(tls("anna"), "Bearer " + token(Role::admin, "right")), "token right-admin, ROLE_ADMIN");
  EXPECT_THAT(who(tls(""), ""), ::testing::StartsWith("a caller over the network without a certificate needs a token"));
  EXPECT_EQ(who(loopback(), "Bearer " + token(Role::observer, "right")), "token right-observer, ROLE_OBSERVER");
}

// The motion bears the name of the token.
TEST_F(RpcAccess, AMotionByToken) {
  grpc::ClientContext context;
  limit(context);
  context.AddMetadata("authorization", "Bearer " + token(Role::operator_, "right"));
  v1::MoveResponse response;
  ASSERT_TRUE(stage_->Move(&context, move_request(1, "1"), &response).ok());
  EXPECT_EQ(response.motion().caller().name(), "token right-operator");
}

// "BEC: RESET: FMT: MODE: MS: P:ON" are administrators', however they are written, and none of the other lines goes.
TEST_F(RpcAccess, CommandsForAdministrators) {
  for (const std::string line : {"BEC:D", "bec: D", "MODE:MANUAL", "FMT:HIT", "RESET:", "MS:ON", "P:ON"}) {
    grpc::ClientContext context;
    limit(context);
    v1::ExecuteRequest request;
    request.set_device("devices/stage");
    request.add_lines("C:11");
    request.add_lines(line);
    const auto commands = v1::CommandService::NewStub(loopback());
    const auto stream = commands->Execute(&context, request);
    v1::ExecuteResponse response;
    EXPECT_FALSE(stream->Read(&response)) << line;
    const grpc::Status status = stream->Finish();
    EXPECT_EQ(status.error_code(), grpc::PERMISSION_DENIED) << line << " " << status.error_message();
    EXPECT_EQ(reason(status), v1::REASON_NOT_ALLOWED);
  }
}

}  // namespace
}  // namespace axisgate::rpc
