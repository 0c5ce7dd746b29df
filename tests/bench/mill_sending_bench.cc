// Jobs of 150,000 commands through the sender at 9600 baud, in virtual time: the cost for the host, the precision of
// the progress, and the cost of a window. Prints tables; compare only figures of one run.
#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <string>
#include <utility>
#include <vector>

#include "tests/rml1/fed_mill.h"
#include "tests/rml1/sender_line.h"
#include "tests/rml1/short_vectors.h"

namespace axisgate::rml1 {
namespace {

constexpr int kCommands = 150'000, kFewer = 5'000;
constexpr Duration kMinute = std::chrono::minutes(1);

struct Job {
  std::string_view name;
  std::string (*text)(int commands);
};

// Returns a relief as in mill_bench.cc, with 2 mm per command.
std::string relief(int commands) {
  std::string job = prologue() + "!MC0;V10;\n";
  for (int index = 0; index < commands; ++index) {
    job += fmt::format("Z{},{},{}\n", 30'000 + std::lround(20'000 * std::cos(index * 0.01)),
                       30'000 + std::lround(20'000 * std::sin(index * 0.01)), -100 - index % 97);
  }
  return job + epilogue(short_vectors_profile(), false);
}

constexpr Job kRelief{"relief, 2 mm", relief}, kUniform{"uniform, 0.2 mm", uniform_vectors},
    kBursts{"bursts, 0.08 mm", bursts_of_vectors};

// Pair of a mill and the profile that the sender uses for it.
struct Pair {
  std::string_view name;
  Profile profile;
  std::string_view acceleration;
  double slower_percent;
};

std::vector<Pair> pairs() {
  return {{"as measured", measured_profile(), "none", 0},
          {"as the profile's slow end", short_vectors_profile(), "worst", 50},
          {"as the profile's best", short_vectors_profile(), "best", 0},
          {"without acceleration", short_vectors_profile(), "none", 0}};
}

simulator::MillSetup setup_of(const Pair& pair) {
  simulator::MillSetup setup;
  setup.profile = pair.profile;
  setup.options.set("acceleration", pair.acceleration);
  setup.slower_percent = pair.slower_percent;
  setup.flow = simulator::Flow::rts;
  return setup;
}

double cpu_s() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }
double allocated_mib() {
  const auto info = mallinfo2();
  return static_cast<double>(info.uordblks + info.hblkhd) / (1 << 20);
}

// Line without a simulated mill at its end, so that only the cost of the sender remains.
class Drain : public FlowLink {
 public:
  void run_to(TimePoint now) {
    while (unsent_ > 0 && last_ + kByte <= now) last_ += kByte, --unsent_;
    if (unsent_ == 0) last_ = now;
  }
  void write(std::string_view bytes) override { unsent_ += bytes.size(); }
  void reopen(Duration) override {}
  std::size_t unsent() const override { return unsent_; }
  bool held() const override { return false; }
  void ignore_flow_control(bool) override {}

 private:
  static constexpr Duration kByte = std::chrono::nanoseconds(std::chrono::seconds(10)) / 9600;
  std::size_t unsent_ = 0;
  TimePoint last_{};
};

void cost(const Job& job, jobs::Streaming streaming) {
  const std::string text = job.text(kCommands);
  const Profile profile = short_vectors_profile();
  const double memory = allocated_mib(), begin = cpu_s();
  const Timeline timeline(text, profile, kAtHome);
  const double planned = cpu_s();
  Drain line;
  const jobs::SendSettings settings{.streaming = streaming, .flow_control = streaming == jobs::Streaming::full};
  SenderLine beside(profile, settings, line);
  Sender sender(text, timeline, profile, settings, plan_of(text, timeline, settings), beside.mill());
  const double ready = cpu_s();
  double most = allocated_mib();
  TimePoint end{};
  feed_all(sender, line, kMinute, [&](TimePoint now) {
    sender.progress(now);
    most = std::max(most, allocated_mib());
    end = now;
  });
  const double all = cpu_s() - ready;
  fmt::print("| {} | {} | {:.1f} | {:.2f} | {:.0f} | {:.0f} | {:.2f} | {:.1f} | {:.1f} |\n", job.name,
             streaming == jobs::Streaming::full ? "full" : "paced", static_cast<double>(text.size()) / 1e6,
             std::chrono::duration<double, std::ratio<3600>>(end.time_since_epoch()).count(), (planned - begin) * 1e3,
             (ready - planned) * 1e3, all, all / kCommands * 1e6, most - memory);
}

// Statistics of the progress at every minute: width of its range, and distance of its middle from the truth.
struct Width {
  int minutes = 0, outside = 0;
  double most = 0, sum = 0, off_most = 0, off_sum = 0;  // bytes; off: distance of the middle from the truth

  void take(const jobs::SendProgress& progress, std::uint64_t truth) {
    ++minutes;
    if (truth < progress.executed_least || truth > progress.executed_most) ++outside;
    const auto least = static_cast<double>(progress.executed_least), far = static_cast<double>(progress.executed_most);
    const double width = far - least, off = std::abs((far + least) / 2 - static_cast<double>(truth));
    most = std::max(most, width);
    sum += width;
    off_most = std::max(off_most, off);
    off_sum += off;
  }
};

void progress(const Job& job, const Pair& pair, jobs::SendSettings settings) {
  const std::string text = job.text(kCommands);
  const Timeline timeline(text, pair.profile, kAtHome);
  const double begin = cpu_s();
  FedMill line(text, setup_of(pair), settings.baud);
  SenderLine beside(pair.profile, settings, line);
  Sender sender(text, timeline, pair.profile, settings, plan_of(text, timeline, settings), beside.mill());
  Width width;
  feed_all(sender, line, kMinute, [&](TimePoint now) { width.take(sender.progress(now), line.executed()); });
  const auto part = [&](double bytes) { return bytes / static_cast<double>(text.size()) * 100; };
  fmt::print("| {} | {} | {} | {:.2f} | {} | {} | {:.0f} ({:.3f} %) | {:.0f} | {:.0f} ({:.3f} %) | {:.0f} | {:.1f} |\n",
             job.name, pair.name, settings.streaming == jobs::Streaming::full ? "full" : "paced", line.seconds() / 3600,
             width.minutes, width.outside, width.most, part(width.most), width.sum / width.minutes, width.off_most,
             part(width.off_most), width.off_sum / width.minutes, cpu_s() - begin);
}

double seconds(const std::string& job, const Pair& pair, jobs::SendSettings settings) {
  const Timeline timeline(job, pair.profile, kAtHome);
  FedMill line(job, setup_of(pair), settings.baud);
  SenderLine beside(pair.profile, settings, line);
  Sender sender(job, timeline, pair.profile, settings, plan_of(job, timeline, settings), beside.mill());
  feed_all(sender, line, kMinute, [](TimePoint) {});
  return line.seconds();
}

void loss(const Job& job, const Pair& pair, double slack) {
  const std::string text = job.text(kFewer);
  const double full = seconds(text, pair, {.streaming = jobs::Streaming::full, .flow_control = true});
  fmt::print("| {} | {} | {:g} |", job.name, pair.name, slack);
  for (const std::size_t window : {64, 128, 256, 0}) {
    fmt::print(" {:.1f} % |", (seconds(text, pair, {.window = window, .slack = slack}) / full - 1) * 100);
  }
  const Timeline timeline(text, pair.profile, kAtHome);
  Drain line;
  fmt::print(" {} |\n", plan_of(text, timeline, {.slack = slack}).run_on.at_most);
}

void print_all() {
  fmt::print("\nThe sender alone, {} commands\n\n", kCommands);
  fmt::print(
      "| job | streaming | MB | hours | timeline, ms CPU | window, ms CPU | sending, s CPU | us a command | MiB |\n"
      "|---|---|---|---|---|---|---|---|---|\n");
  for (const Job& job : {kRelief, kUniform, kBursts}) {
    for (const jobs::Streaming streaming : {jobs::Streaming::paced, jobs::Streaming::full}) cost(job, streaming);
  }
  fmt::print("\nProgress at every minute, {} commands; bytes\n\n", kCommands);
  fmt::print(
      "| job | mill | streaming | hours | minutes | outside | width, most | mean | middle off, most | mean | s CPU |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const Job& job : {kRelief, kUniform}) {
    for (const Pair& pair : pairs()) {
      for (const jobs::Streaming streaming : {jobs::Streaming::paced, jobs::Streaming::full})
        progress(job, pair, {.streaming = streaming, .flow_control = streaming == jobs::Streaming::full});
    }
  }
  fmt::print("\nLonger than with full streaming, {} commands, by window in bytes\n\n", kFewer);
  fmt::print("| job | mill | slack | 64 | 128 | 256 | adapted | bytes |\n|---|---|---|---|---|---|---|---|\n");
  for (const Job& job : {kRelief, kUniform, kBursts}) {
    for (const Pair& pair : pairs()) {
      for (const double slack : {1.0, 1.1, 1.5}) loss(job, pair, slack);
    }
  }
}

}  // namespace
}  // namespace axisgate::rml1

int main() { axisgate::rml1::print_all(); }
