// Translates the acts of the conformance scenario into calls of this package, one JSON object on a line each way.
#include <chrono>
#include <functional>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "axisgate/axisgate.h"

namespace {

using axisgate::Distance;
using Json = nlohmann::json;

// A program's own error while it computes a path.
struct PointFailed {};

std::chrono::milliseconds from_seconds(double seconds) {
  return std::chrono::milliseconds(static_cast<std::int64_t>(seconds * 1000));
}

Distance amount(const Json& json) {
  // The scenario's bare numbers do not compile in a program.
  static_assert(!std::is_convertible_v<double, Distance>);
  const std::string unit = json.value("unit", "");
  if (json.contains("text")) return {json["text"].get<std::string>(), unit};
  const Json& number = json["number"];
  return {number.is_string() ? std::stod(number.get<std::string>()) : number.get<double>(), unit};
}

std::optional<axisgate::Speed> speed(const Json& act) {
  return act.contains("speed") ? std::optional(amount(act["speed"]).per_second()) : std::nullopt;
}

axisgate::MoveOptions move_options(const Json& act) { return {.speed = speed(act)}; }

std::vector<std::string> axes_of(const Json& act) { return act.value("axes", std::vector<std::string>()); }

Json done(const axisgate::MotionResult& result) {
  Json positions = Json::object();
  for (const axisgate::Position& position : result.positions) positions[position.axis] = position.value;
  return {{"outcome", "done"}, {"positions", positions}};
}

class Runner {
 public:
  Json perform(const Json& act) { return kVerbs.at(act["say"])(*this, act); }

 private:
  using Verb = Json (*)(Runner&, const Json&);
  static const std::map<std::string, Verb> kVerbs;

  axisgate::Stage& stage() {
    if (!stage_) stage_.emplace();
    return *stage_;
  }

  Json open(const Json& act) {
    stage_.emplace(axisgate::ConnectOptions{.target = act.value("target", ""),
                                            .token = act.value("token", ""),
                                            .ca = act.value("ca", ""),
                                            .certificate = act.value("certificate", ""),
                                            .key = act.value("key", "")});
    return {{"outcome", "done"}};
  }

  Json axes() {
    Json axes = Json::array();
    for (const axisgate::Axis& axis : stage().axes()) axes.push_back({axis.name(), axis.number()});
    return {{"outcome", "done"}, {"axes", axes}};
  }

  Json move_to(const Json& act) {
    std::stop_source source;
    axisgate::MoveOptions options = move_options(act);
    options.stop = source.get_token();
    std::jthread interrupter;
    if (act.contains("interrupt_after")) {
      interrupter = std::jthread([&source, after = from_seconds(act["interrupt_after"])] {
        std::this_thread::sleep_for(after);
        source.request_stop();
      });
    }
    return done(stage()[act["axis"].get<std::string>()].move_to(amount(act["amount"]), options));
  }

  Json wait(const Json& act) {
    const axisgate::Motion& motion = motions_.at(act["motion"]);
    if (!act.contains("timeout")) return done(motion.wait());
    const auto result = motion.wait_for(from_seconds(act["timeout"]));
    return result ? done(*result) : Json{{"outcome", "timeout"}};
  }

  Json path(const Json& act) {
    const std::vector<std::string> steps = act["step"];
    const std::string unit = act["unit"];
    const auto point_at = [&](int number) {
      if (act.contains("fails_after") && number > act["fails_after"]) throw PointFailed();
      axisgate::Point point;
      for (const std::string& step : steps) point.emplace_back(std::to_string(number * std::stoi(step)), unit);
      return point;
    };
    return done(stage()
                    .path(std::views::iota(1, act["count"].get<int>() + 1) | std::views::transform(point_at),
                          axes_of(act), speed(act))
                    .wait());
  }

  Json scan(const Json& act) {
    const axisgate::MotionResult result = stage()
                                              .scan({.axis = act["axis"],
                                                     .start = amount(act["from"]),
                                                     .end = amount(act["to"]),
                                                     .every = amount(act["every"]),
                                                     .speed = speed(act)})
                                              .wait();
    return {{"outcome", "done"},
            {"expected", *result.scan->expected_in_range},
            {"observed_equals_expected", result.scan->observed == result.scan->expected}};
  }

  // Reads events until so many motions have succeeded.
  Json succeeded(const Json& act) {
    int gaps = 0;
    for (int ended = 0; ended < act["count"];) {
      const auto item = events_->next();
      const auto* event = std::get_if<axisgate::Event>(&*item);
      if (event == nullptr) {
        ++gaps;
        continue;
      }
      revisions_.push_back(event->revision);
      const Json message = Json::parse(event->json);
      if (message.contains("motion") && message["motion"]["state"] == "MOTION_STATE_SUCCEEDED") ++ended;
    }
    const bool ascending = std::ranges::adjacent_find(revisions_, std::greater_equal()) == revisions_.end();
    return {{"outcome", "done"}, {"ascending", ascending}, {"gaps", gaps}};
  }

  std::optional<axisgate::Stage> stage_;
  std::map<std::string, axisgate::Motion> motions_;
  std::map<std::string, axisgate::Lease> leases_;
  std::optional<axisgate::Events> events_;
  std::vector<std::uint64_t> revisions_;
  std::vector<std::jthread> waiting_;
};

const Json kDone{{"outcome", "done"}};

const std::map<std::string, Runner::Verb> Runner::kVerbs = {
    {"open", [](Runner& self, const Json& act) { return self.open(act); }},
    {"whoami",
     [](Runner& self, const Json&) -> Json {
       return {{"outcome", "done"}, {"role", self.stage().whoami().role}};
     }},
    {"axes", [](Runner& self, const Json&) { return self.axes(); }},
    {"home", [](Runner& self, const Json& act) { return done(self.stage().home(axes_of(act))); }},
    {"move_to", [](Runner& self, const Json& act) { return self.move_to(act); }},
    {"move_by",
     [](Runner& self, const Json& act) {
       return done(self.stage()[act["axis"].get<std::string>()].move_by(amount(act["amount"])));
     }},
    {"start",
     [](Runner& self, const Json& act) -> Json {
       const auto motion = self.stage()[act["axis"].get<std::string>()].start(amount(act["amount"]), move_options(act));
       self.motions_.insert_or_assign(act["motion"], motion);
       return {{"outcome", "started"}};
     }},
    {"wait", [](Runner& self, const Json& act) { return self.wait(act); }},
    {"cancel",
     [](Runner& self, const Json& act) {
       self.motions_.at(act["motion"]).cancel();
       return kDone;
     }},
    {"stop",
     [](Runner& self, const Json&) -> Json {
       return {{"outcome", "done"}, {"stays_open", self.stage().stop().stays_open}};
     }},
    {"rearm",
     [](Runner& self, const Json&) {
       self.stage().rearm();
       return kDone;
     }},
    {"lease",
     [](Runner& self, const Json& act) {
       self.leases_.emplace(act["lease"], self.stage().lease({.axes = axes_of(act), .ttl = from_seconds(act["ttl"])}));
       return kDone;
     }},
    {"lost",
     [](Runner& self, const Json& act) -> Json {
       return {{"outcome", "done"},
               {"lost", self.leases_.at(act["lease"]).wait_lost(from_seconds(act.value("within", 0.0)))}};
     }},
    {"release",
     [](Runner& self, const Json& act) {
       self.leases_.at(act["lease"]).release();
       self.leases_.erase(act["lease"].get<std::string>());
       return kDone;
     }},
    {"path", [](Runner& self, const Json& act) { return self.path(act); }},
    {"scan", [](Runner& self, const Json& act) { return self.scan(act); }},
    {"events",
     [](Runner& self, const Json&) {
       self.events_.emplace(self.stage().events());
       return kDone;
     }},
    {"succeeded", [](Runner& self, const Json& act) { return self.succeeded(act); }},
    {"saturate",
     [](Runner& self, const Json& act) {
       const axisgate::Motion motion = self.motions_.at(act["motion"]);
       for (int call = 0; call < act["calls"]; ++call) {
         self.waiting_.emplace_back([motion] {
           try {
             motion.wait();
           } catch (const axisgate::Error&) {
           }
         });
       }
       return kDone;
     }},
};

Json reply_to(const char* outcome, const axisgate::Error& error) {
  Json reply{{"outcome", outcome}, {"reason", error.reason()}, {"message", error.message()}, {"hint", error.hint()}};
  if (error.axis()) reply["axis"] = *error.axis();
  return reply;
}

Json reply(Runner& runner, const Json& act) {
  try {
    return runner.perform(act);
  } catch (const axisgate::Refused& error) {
    return reply_to("refused", error);
  } catch (const axisgate::Stopped& error) {
    return reply_to("stopped", error);
  } catch (const axisgate::MotionFailed& error) {
    return reply_to("failed", error);
  } catch (const axisgate::OutcomeUnknown& error) {
    return reply_to("unknown", error);
  } catch (const axisgate::Interrupted&) {
    return {{"outcome", "interrupted"}};
  } catch (const axisgate::InvalidArgument& error) {
    return {{"outcome", "local"}, {"message", error.what()}};
  } catch (const PointFailed&) {
    return {{"outcome", "local"}};
  } catch (const std::exception& error) {
    return {{"outcome", "unexpected"}, {"message", error.what()}};
  }
}

}  // namespace

int main() {
  Runner runner;
  for (std::string line; std::getline(std::cin, line);) {
    std::cout << reply(runner, Json::parse(line)).dump() << std::endl;
  }
}
