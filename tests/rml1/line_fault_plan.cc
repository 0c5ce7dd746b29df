#include "tests/rml1/line_fault_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <string_view>

#include "device/rml1/sending/timeline.h"
#include "tests/rml1/random_mill_job.h"
#include "tests/rml1/simulator_bench.h"
#include "tests/rml1/trace.h"
#include "tests/simulation/random.h"

namespace axisgate::rml1 {
namespace {

using simulation::Random;
using simulator::Flow;

constexpr std::array<std::string_view, 7> kActs = {"pause",           "resume",      "abort",       "CTS is stuck",
                                                   "CTS is released", "line breaks", "line is back"};
constexpr std::array kBytes = {"none", "lost", "doubled", "flipped"};
constexpr std::array kBefore = {"nothing", "the line breaks", "an abort", "an abort, and confirmed at once"};
constexpr std::array kFlowNames = {"none", "xon", "rts"};

Duration within(Random& random, std::chrono::milliseconds least, std::chrono::milliseconds most) {
  return std::chrono::milliseconds(random.between(least.count(), most.count()));
}

void draw_mill(Random& random, LineFaultPlan& plan) {
  const auto flow = random.pick<Flow>({Flow::none, Flow::xon, Flow::rts});
  const bool full = flow != Flow::none && random.chance(0.5);
  const std::size_t buffer = random.pick<std::size_t>({128, 512, 1024});
  const std::size_t converter = random.pick<std::size_t>({0, 16, 128});
  plan.mill = simulator::with_options({{"escape_k", random.pick<std::string_view>({"toggle", "one-shot", "in-band"})},
                                       {"acceleration", random.pick<std::string_view>({"none", "best", "worst"})}});
  plan.mill.flow = flow;
  plan.mill.buffer_bytes = buffer;
  plan.mill.slower_percent = static_cast<double>(random.between(0, 50));
  plan.settings.sending = {.streaming = full ? jobs::Streaming::full : jobs::Streaming::paced,
                           .buffer = buffer,
                           .converter = converter,
                           .flow_control = flow != Flow::none};
  plan.settings.busy_limit = std::chrono::seconds(30);
  plan.line = {.shows_cts = flow == Flow::rts, .converter = converter, .late = random.pick<std::size_t>({0, 16})};
}

void draw_bytes(Random& random, LineFaultPlan& plan) {
  plan.loses_xon = plan.mill.flow == Flow::xon && random.chance(0.6);
  if (!random.chance(0.25)) return;
  plan.byte = random.pick<ByteFault>({ByteFault::lost, ByteFault::doubled, ByteFault::flipped});
  plan.byte_at = static_cast<std::size_t>(random.between(0, static_cast<std::int64_t>(plan.body.size())));
  plan.bit = static_cast<int>(random.between(0, 7));
}

void draw_stuck(Random& random, LineFaultPlan& plan, Duration job) {
  if (plan.mill.flow != Flow::rts || !random.chance(0.5)) return;
  const Duration at(random.between(0, job.count()));
  plan.acts.push_back({Act::Kind::stick, at});
  plan.sticks_forever = random.chance(0.5);
  if (plan.sticks_forever) return;
  plan.acts.push_back(
      {Act::Kind::release, at + within(random, std::chrono::milliseconds(5), std::chrono::milliseconds(60'000))});
}

// Draws acts of people and of the cable. Draws none if CTS is stuck for ever, because the job then waits until it is
// aborted.
void draw_people_and_cable(Random& random, LineFaultPlan& plan, Duration job) {
  if (plan.sticks_forever) return;
  const auto moment = [&] { return Duration(random.between(0, job.count())); };
  if (random.chance(0.25)) {
    const Duration at = moment();
    plan.acts.push_back({Act::Kind::pause, at});
    plan.acts.push_back(
        {Act::Kind::resume, at + within(random, std::chrono::milliseconds(0), std::chrono::milliseconds(20'000))});
  }
  if (random.chance(0.35)) plan.acts.push_back({Act::Kind::abort, moment()});
  if (random.chance(0.3)) {
    const Duration at = moment();
    plan.acts.push_back({Act::Kind::unplug, at});
    plan.acts.push_back(
        {Act::Kind::plug_in, at + within(random, std::chrono::milliseconds(50), std::chrono::milliseconds(20'000))});
    plan.keeps_converter = random.chance(0.5);
  }
}

}  // namespace

std::string_view name(Act::Kind kind) { return kActs.at(static_cast<std::size_t>(kind)); }

LineFaultPlan line_fault_plan(std::uint64_t seed, const Profile& profile) {
  Random random(seed);
  LineFaultPlan plan;
  plan.body = random_mill_job(seed, static_cast<std::size_t>(random.between(60, 900)));
  draw_mill(random, plan);
  draw_bytes(random, plan);
  const double slack = plan.settings.sending.streaming == jobs::Streaming::paced ? plan.settings.sending.slack : 1;
  const std::chrono::duration<double> longest(Timeline(plan.body, profile, kMidway).slowest_s() * slack);
  const auto job = std::chrono::duration_cast<Duration>(longest);
  draw_stuck(random, plan, job);
  draw_people_and_cable(random, plan, job);
  if (random.chance(0.3)) {
    plan.before_start =
        random.pick<BeforeStart>({BeforeStart::line_breaks, BeforeStart::abort, BeforeStart::abort_and_at_once});
  }
  std::ranges::stable_sort(plan.acts, {}, &Act::at);
  return plan;
}

std::string text_of(const LineFaultPlan& plan) {
  const jobs::SendSettings& sending = plan.settings.sending;
  std::string text = fmt::format(
      "{}, flow {}, mill {} % slower, {}, buffer {}, converter {}{}, {} bytes late; byte {} {} (bit {}){}; before the "
      "start: {}",
      sending.streaming == jobs::Streaming::paced ? "paced" : "full",
      kFlowNames.at(static_cast<std::size_t>(plan.mill.flow)), plan.mill.slower_percent, plan.mill.options.describe(),
      sending.buffer, sending.converter, plan.keeps_converter ? " (it keeps its bytes)" : "", plan.line.late,
      plan.byte_at, kBytes.at(static_cast<std::size_t>(plan.byte)), plan.bit, plan.loses_xon ? ", an XON lost" : "",
      kBefore.at(static_cast<std::size_t>(plan.before_start)));
  for (const Act& act : plan.acts)
    text += fmt::format("; {} after {} ms", name(act.kind), act.at / std::chrono::milliseconds(1));
  return text;
}

}  // namespace axisgate::rml1
