// Measurement of callers that each ask one question at a time: directly, through the daemon, and through the minimal
// gateway.
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "axisgate/v1/access.grpc.pb.h"
#include "axisgate/v1/device.grpc.pb.h"
#include "bench/minimal.grpc.pb.h"
#include "tests/bench/callers.h"
#include "tests/bench/daemon.h"
#include "tests/bench/measurement.h"
#include "tests/bench/raw_line.h"
#include "tests/bench/subcommands.h"
#include "tests/paced/track.h"

namespace axisgate::bench {
namespace {

struct Options {
  std::vector<std::string> targets;
  std::string certificates;
  std::vector<std::string> questions = {"Q:SPC"};
  bool own_questions = false;
  int max_age_ms = 0;
  Load load;
};

// Returns the target of a caller. The callers are divided among the targets, because the daemon limits the requests per
// second of one source.
const std::string& target_of(const Options& options, int caller) {
  return options.targets[static_cast<std::size_t>(caller) % options.targets.size()];
}

std::shared_ptr<grpc::Channel> channel_of(const Options& options, int caller) {
  return connect(target_of(options, caller), options.certificates);
}

// Returns the questions of a caller. The questions are divided among the callers; if there are fewer questions than
// callers, several callers ask the same question.
std::vector<std::string> questions_of(const Options& options, int caller) {
  const auto& all = options.questions;
  std::vector<std::string> own;
  for (auto i = static_cast<std::size_t>(caller); i < all.size(); i += static_cast<std::size_t>(options.load.callers)) {
    own.push_back(all[i]);
  }
  if (own.empty()) own.push_back(all[static_cast<std::size_t>(caller) % all.size()]);
  return own;
}

template <class AskOne>
Ask in_turn(std::vector<std::string> questions, AskOne ask_one) {
  return [questions = std::move(questions), ask_one = std::move(ask_one), next = std::size_t(0)]() mutable {
    ask_one(questions[next++ % questions.size()]);
  };
}

Ask direct(const Options& options, int caller) {
  const auto line = std::make_shared<RawLine>(RawLine::open_tty(target_of(options, caller)));
  return in_turn(questions_of(options, caller), [line](const std::string& question) { line->ask(question); });
}

Ask hello(const Options& options, int caller) {
  const std::shared_ptr<Minimal::Stub> stub = Minimal::NewStub(channel_of(options, caller));
  return [stub] {
    grpc::ClientContext context;
    HelloResponse response;
    check(stub->Hello(&context, HelloRequest(), &response));
  };
}

Ask minimal(const Options& options, int caller) {
  const std::shared_ptr<Minimal::Stub> stub = Minimal::NewStub(channel_of(options, caller));
  return in_turn(questions_of(options, caller), [stub](const std::string& question) {
    AskRequest request;
    request.set_line(question);
    grpc::ClientContext context;
    AskResponse response;
    check(stub->Ask(&context, request, &response));
  });
}

Ask execute_line(const Options& options, int caller) {
  const std::shared_ptr<v1::CommandService::Stub> stub = v1::CommandService::NewStub(channel_of(options, caller));
  return in_turn(questions_of(options, caller), [stub](const std::string& question) { execute(*stub, {question}); });
}

Ask get_device(const Options& options, int caller) {
  const std::shared_ptr<v1::DeviceService::Stub> stub = v1::DeviceService::NewStub(channel_of(options, caller));
  v1::GetDeviceRequest request;
  request.set_device(kDevice);
  request.mutable_max_age()->set_seconds(options.max_age_ms / 1000);
  request.mutable_max_age()->set_nanos(options.max_age_ms % 1000 * 1'000'000);
  return [stub, request] {
    grpc::ClientContext context;
    v1::GetDeviceResponse response;
    check(stub->GetDevice(&context, request, &response));
  };
}

Ask get_caller(const Options& options, int caller) {
  const std::shared_ptr<v1::AccessService::Stub> stub = v1::AccessService::NewStub(channel_of(options, caller));
  return [stub] {
    grpc::ClientContext context;
    v1::GetCallerResponse response;
    check(stub->GetCaller(&context, v1::GetCallerRequest(), &response));
  };
}

struct Kind {
  const char* name;
  const char* help;
  Ask (*make)(const Options& options, int caller);
};

constexpr Kind kKinds[] = {
    {"direct", "Lines on a tty, without a gateway", direct},
    {"hello", "A bare call of axisgate-bench-server", hello},
    {"minimal", "Lines through axisgate-bench-server", minimal},
    {"execute", "CommandService.Execute of the daemon", execute_line},
    {"get_device", "DeviceService.GetDevice of the daemon", get_device},
    {"get_caller", "AccessService.GetCaller, the daemon's barest call", get_caller},
};

void add(CLI::App& program, const Kind& kind) {
  CLI::App& sub = *program.add_subcommand(kind.name, kind.help);
  const auto options = std::make_shared<Options>();
  sub.add_option("--target", options->targets, "A tty, unix:PATH or HOST:PORT; may be repeated")->required();
  sub.add_option("--certificates", options->certificates, "Folder of the certificates: by TLS");
  auto* questions = sub.add_option("--question", options->questions, "A line; may be repeated");
  sub.add_flag("--own-questions", options->own_questions, "Those of the paced paths, one a caller")
      ->excludes(questions);
  sub.add_option("--max-age", options->max_age_ms, "Of get_device, in milliseconds");
  sub.add_option("--callers", options->load.callers, "How many, a connection each")->check(CLI::Range(1, 1000));
  sub.add_option("--seconds", options->load.seconds, "How long");
  sub.add_option("--pause", options->load.pause_ms, "Of a caller after each answer, in milliseconds");
  sub.callback([options, make = kind.make] {
    if (options->own_questions) {
      options->questions.assign(paced::kOwnQuestions.begin(), paced::kOwnQuestions.end());
    }
    print(measure_callers(options->load, [&](int caller) { return make(*options, caller); }));
  });
}

}  // namespace

void add_asks(CLI::App& program) {
  for (const Kind& kind : kKinds) add(program, kind);
}

}  // namespace axisgate::bench
