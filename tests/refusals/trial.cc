#include "tests/refusals/trial.h"

#include <algorithm>
#include <memory>

#include "tests/unit/simulator/simulator_bench.h"

namespace axisgate::refusals {
namespace {

using namespace shrc203;
using simulation::LineKind;
using simulation::Scripted;
using simulation::World;
using std::chrono::milliseconds;
using std::chrono::seconds;

// Lines that save a place and coordinates under number 1, and a program 1 that takes half a minute.
const Lines kStored = {"PIT:SET,1",   "PAV:SET,1", "P:R", "P:ON", "P:SET,1,M,1,0,0,1900000,0,0,0,1,0,5",
                       "P:SET,2,END", "P:OFF",     "P:H"};

simulation::Setup set_up(const Condition& condition) {
  simulation::Setup setup;
  setup.profile.baud = setup.baud;
  setup.profile.wait_for_inputs = true;
  setup.callers_send_bare_go = true;
  if (condition.set_up) condition.set_up(setup);
  return setup;
}

// Starts a jog. The request's limit of 300 ms is shorter than the silence after which the watchdog stops a jog.
void jog(World& world, std::shared_ptr<Verdict> told, std::optional<Quantity> speed = {}) {
  JogRequest request;
  request.axes = {{1, 1, std::move(speed)}};
  request.context = world.context("tester", milliseconds(300));
  world.controller().jog(request, world.now(), [told](const Result<Motion>& started) {
    told->ended = true;
    if (!started) told->problem = started.error();
  });
}

void execute(World& world, const Lines& lines, std::shared_ptr<Verdict> told) {
  world.controller().execute({lines, world.context("tester", seconds(3))}, world.now(),
                             [told](const ExecuteEvent& event) {
                               if (event.kind == ExecuteEvent::Kind::reply) told->answers.push_back(event.answer);
                               if (event.kind != ExecuteEvent::Kind::ended) return;
                               told->ended = true;
                               told->problem = event.problem;
                             });
}

}  // namespace

std::string at_simulator(const Condition& condition, const Case& one) {
  simulator::SimulatorBench bench({}, set_up(condition).options);
  for (const Lines* lines : {&condition.device_before, &kStored, &one.simulator_before}) {
    for (const std::string& line : *lines) {
      const std::string heard = bench.ask(line);
      if (heard != "OK") return line + " -> " + heard;
    }
    if (lines != &condition.device_before || lines->empty()) continue;
    bench.device.power_cycle(bench.now());
    (void)bench.wait(seconds(2));
  }
  if (condition.strikes) condition.strikes(bench.device, bench.now());
  (void)bench.send("");
  return bench.ask(one.line);
}

Verdict at_gateway(const Condition& condition, const Case& one, Moment moment) {
  World world(set_up(condition));
  // Replies to the other program or person must not reach the gateway.
  bool by_another = true, struck = false, asked = false;
  const auto strike = [&] {
    struck = true;
    by_another = true;
    if (condition.strikes) condition.strikes(world.device(), world.now());
    by_another = false;
  };
  world.wire().set_script([&](LineKind kind, const std::string& line) -> Scripted {
    const bool arrives = asked && kind == LineKind::command && line == one.line;
    if (arrives && moment == Moment::as_it_arrives && !struck) strike();
    return {.drop = by_another && kind != LineKind::command, .delay = {}, .instead = {}};
  });
  for (const std::string& line : kStored) world.device().receive(line + "\r\n", world.now());
  by_another = false;
  (void)world.run_until_up();
  if (!condition.device_before.empty()) {
    by_another = true;
    for (const std::string& line : condition.device_before) world.device().receive(line + "\r\n", world.now());
    by_another = false;
    world.power_cycle();
    world.wire().cut(world.now(), seconds(2));
    world.run_for(seconds(3));
    (void)world.run_until_up();
  }
  if (moment == Moment::before) {
    strike();
    world.run_for(seconds(3));
  }
  asked = true;
  const auto first = world.wire().commands().size();
  const auto told = std::make_shared<Verdict>();
  if (one.line.starts_with("J:") && one.whole.size() == 1 && one.line == one.sentence->line) {
    jog(world, told);
  } else {
    execute(world, one.whole, told);
  }
  (void)world.run_until([&] { return told->ended; }, std::chrono::minutes(3));
  const auto& sent = world.wire().commands();
  told->sent = static_cast<int>(std::count(sent.begin() + static_cast<std::ptrdiff_t>(first), sent.end(), one.line));
  told->replay = world.replay();
  for (const std::string& violation : world.violations()) told->replay = violation + "\n" + told->replay;
  return *told;
}

Verdict of_a_faster_jog(const Condition& condition) {
  World world(set_up(condition));
  bool struck = false;
  world.wire().set_script([&](LineKind kind, const std::string& line) -> Scripted {
    const bool arrives = kind == LineKind::command && line.starts_with("JD:1");
    if (arrives && !struck) {
      struck = true;
      condition.strikes(world.device(), world.now());
    }
    return {};
  });
  Verdict told;
  world.on_motion = [&](const Motion& motion) {
    if (!is_outcome(motion.state)) return;
    told.ended = struck;
    told.problem = motion.problem;
  };
  world.on_news = [&](const Event& event) {
    const auto* ended = std::get_if<ExchangeEnded>(&event);
    if (ended != nullptr && ended->line.starts_with("JD:1")) told.answers.push_back(ended->reply);
  };
  (void)world.run_until_up();
  const auto started = std::make_shared<Verdict>();
  jog(world, started, pulses(2000));
  (void)world.run_until([&] { return told.ended; }, std::chrono::minutes(1));
  told.replay = world.replay();
  return told;
}

}  // namespace axisgate::refusals
