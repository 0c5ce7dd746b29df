// save, positions, go and forget: saved positions of the stage.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "clients/axisctl/arguments/verb_options.h"
#include "clients/axisctl/failure.h"
#include "clients/axisctl/outcome.h"
#include "clients/axisctl/parse.h"
#include "clients/axisctl/print.h"
#include "clients/axisctl/stage/setting_calls.h"
#include "clients/axisctl/verbs.h"

namespace axisgate::axisctl {
namespace {

std::string position_name(const Session& session, const v1::Device& device) {
  return fmt::format("{}/positions/{}", device.name(), session.options.name);
}

std::string places_text(const v1::Device& device, const v1::Position& position) {
  std::vector<std::string> places;
  for (const v1::PositionCoordinate& coordinate : position.coordinates()) {
    const v1::Axis& axis = find_axis(device, std::to_string(coordinate.axis()));
    places.push_back(place_text(axis, coordinate.pulses()));
  }
  return fmt::format("{}", fmt::join(places, ", "));
}

std::string whole_text(const v1::Device& device, const v1::Position& position) {
  const bool place = position.kind() == v1::POSITION_KIND_PLACE;
  return fmt::format("{}  {} {}  {}  saved {} by {}{}", last_part(position.name()), place ? "place" : "coordinates",
                     position.number(), places_text(device, position), time_text(position.save_time()),
                     position.caller().name(), position.emptied() ? "  the controller may have lost it" : "");
}

int save_position(const Session& session) {
  const v1::Device device = chosen_device(session);
  v1::SavePositionRequest request;
  *request.mutable_context() = session.connection.new_call_context();
  request.set_position(position_name(session, device));
  request.set_kind(session.options.coordinates ? v1::POSITION_KIND_COORDINATES : v1::POSITION_KIND_PLACE);
  request.set_keep_existing(session.options.keep);
  const v1::SavePositionResponse saved = session.connection.call(
      session.connection.positions, &v1::PositionService::Stub::SavePosition, request, kSettingLimit);
  if (session.options.json) {
    print_json(saved.position());
  } else {
    print_line(fmt::format("{}: {}", last_part(saved.position().name()), places_text(device, saved.position())));
  }
  return kDone;
}

int list_positions(const Session& session) {
  const v1::Device device = chosen_device(session);
  v1::ListPositionsRequest request;
  request.set_device(device.name());
  const v1::ListPositionsResponse there = session.connection.call(
      session.connection.positions, &v1::PositionService::Stub::ListPositions, request, kQuestionLimit);
  for (const v1::Position& position : there.positions()) {
    session.options.json ? print_json(position) : print_line(whole_text(device, position));
  }
  if (there.positions().empty() && !session.options.json) print_line("no saved positions");
  return kDone;
}

int go_to_position(const Session& session) {
  const v1::Device device = chosen_device(session);
  v1::MoveToPositionRequest request;
  *request.mutable_context() = session.connection.new_call_context();
  request.set_position(position_name(session, device));
  return start_and_wait(session, device, [&] {
    return session.connection
        .call(session.connection.positions, &v1::PositionService::Stub::MoveToPosition, request, kStartLimit)
        .motion();
  });
}

int forget_position(const Session& session) {
  v1::DeletePositionRequest request;
  *request.mutable_context() = session.connection.new_call_context();
  request.set_position(position_name(session, chosen_device(session)));
  return report_done(session,
                     session.connection.call(session.connection.positions, &v1::PositionService::Stub::DeletePosition,
                                             request, kSettingLimit));
}

void add_position_name(CLI::App& verb, Options& options) {
  verb.add_option("NAME", options.name, "1 to 40 letters, digits, - and _")->required()->type_name("");
}

void save_options(CLI::App& verb, Options& options) {
  verb.add_flag("--coordinates", options.coordinates, "save the coordinates, not the physical position");
  verb.add_flag("--keep", options.keep, "do not replace a saved position");
  add_position_name(verb, options);
}

void go_options(CLI::App& verb, Options& options) {
  add_waiting(verb, options);
  add_position_name(verb, options);
}

constexpr Verb kPositionVerbs[] = {
    {.words = "save",
     .heading = Heading::moving,
     .description = "save the present position under a name",
     .help =
         R"(A position has the coordinates of all axes. It is a place: it stays the same place when coordinates are set again. A
restart of the controller clears it. With --coordinates the coordinates are saved instead, and kept over a restart. The
controller stores twenty of each kind by number. A new name takes the lowest number without a name. What another program
has stored there is overwritten.)",
     .examples = "axisctl save sample\naxisctl save park --coordinates\naxisctl positions",
     .add_options = save_options,
     .run = save_position,
     .waits = true},
    {.words = "positions",
     .heading = Heading::moving,
     .description = "show the saved positions",
     .examples = "axisctl positions",
     .run = list_positions},
    {.words = "go",
     .heading = Heading::moving,
     .description = "move to a saved position",
     .help = "Moves all axes together. Nothing moves if the controller now holds another position, or none.",
     .examples = "axisctl go sample\naxisctl go park --wait 60",
     .add_options = go_options,
     .run = go_to_position,
     .waits = true},
    {.words = "forget",
     .heading = Heading::moving,
     .description = "delete a saved position",
     .examples = "axisctl forget sample",
     .add_options = add_position_name,
     .run = forget_position,
     .waits = true},
};

}  // namespace

std::span<const Verb> position_verbs() { return kPositionVerbs; }

}  // namespace axisgate::axisctl
