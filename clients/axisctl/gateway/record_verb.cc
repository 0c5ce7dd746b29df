// record: prints the serial traffic, as text that `replay` can read.
#include <fmt/format.h>
#include <semaphore.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <thread>

#include "clients/axisctl/failure.h"
#include "clients/axisctl/interrupt.h"
#include "clients/axisctl/output.h"
#include "clients/axisctl/print.h"
#include "clients/axisctl/verbs.h"

namespace axisgate::axisctl {
namespace {

sem_t record_ended;  // posted by a signal, or when the call is over
volatile std::sig_atomic_t by_signal = 0;

void end_record(int) {
  by_signal = 1;
  sem_post(&record_ended);
}

// EndedBySignal lets Ctrl-C, SIGTERM and SIGHUP end a call normally. Only one object may exist at a time.
class EndedBySignal {
 public:
  explicit EndedBySignal(grpc::ClientContext& call) {
    sem_init(&record_ended, 0, 0);
    on_end_signals(end_record, 0);
    // A thread cancels the call, because gRPC must not be called from a signal handler.
    waiter_ = std::thread([&call] {
      while (sem_wait(&record_ended) != 0 && errno == EINTR) {
      }
      call.TryCancel();
    });
  }

  ~EndedBySignal() {
    sem_post(&record_ended);
    waiter_.join();
  }

  bool came() const { return by_signal != 0; }

 private:
  std::thread waiter_;
};

v1::RecordRequest make_request(const Session& session) {
  v1::RecordRequest request;
  request.set_device(any_device(session).name());
  request.set_skip_kept(session.options.only_new);
  request.set_follow(!session.options.no_follow);
  return request;
}

int record(const Session& session) {
  const v1::RecordRequest request = make_request(session);
  Output output(session.options.output);
  grpc::ClientContext call;
  if (session.options.seconds) {
    call.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(*session.options.seconds));
  }
  const EndedBySignal signal(call);
  const auto reader = session.connection.diagnostics->Record(&call, request);
  v1::RecordResponse response;
  std::ptrdiff_t lines = 0;
  while (reader->Read(&response)) {
    output.write(response.text());
    lines += std::count(response.text().begin(), response.text().end(), '\n');
  }
  const grpc::Status status = reader->Finish();
  if (output.is_file()) print_line(fmt::format("{}: {} lines", output.path(), lines));
  const bool in_time = session.options.seconds && status.error_code() == grpc::StatusCode::DEADLINE_EXCEEDED;
  if (!in_time && !signal.came()) session.connection.check(status);
  return kDone;
}

void record_options(CLI::App& verb, Options& options) {
  verb.add_option("--output", options.output, "the file to write (default: the standard output)")->type_name("FILE");
  CLI::Option* no_follow = verb.add_flag("--no-follow", options.no_follow, "only the last minutes");
  CLI::Option* only_new = verb.add_flag("--new", options.only_new, "without the last minutes");
  CLI::Option* seconds = verb.add_option("--seconds", options.seconds, "end after this time");
  seconds->check(CLI::Range(1, 1'000'000))->type_name("S");
  no_follow->excludes(only_new)->excludes(seconds);
}

constexpr Verb kRecordVerbs[] = {
    {.words = "record",
     .heading = Heading::raw,
     .description = "print the serial traffic: the last minutes, then all that follows until Ctrl-C",
     .examples = "axisctl record --seconds 1 --output stage.recording",
     .add_options = record_options,
     .run = record,
     .has_json = false},
};

}  // namespace

std::span<const Verb> record_verbs() { return kRecordVerbs; }

}  // namespace axisgate::axisctl
