#include "axisgate/places.h"

#include <utility>

#include "clients/cpp/src/amounts.h"
#include "clients/cpp/src/outcomes.h"
#include "clients/cpp/src/session.h"

namespace axisgate {
namespace {

using PositionStub = v1::PositionService::Stub;

// Time that saving may wait for the end of a running motion.
constexpr std::chrono::seconds kSaveTime{20};
constexpr int kPage = 1000;

std::string place_name(const client::DeviceSession& session, const std::string& name) {
  return session.device() + "/positions/" + name;
}

void save_position(client::DeviceSession& session, const std::string& name, v1::PositionKind kind) {
  v1::SavePositionRequest request;
  request.set_position(place_name(session, name));
  request.set_kind(kind);
  session.act(session.services().positions, &PositionStub::SavePosition, request, kSaveTime);
}

}  // namespace

void Places::save(const std::string& name) const { save_position(*session_, name, v1::POSITION_KIND_PLACE); }

void Places::save_coordinates(const std::string& name) const {
  save_position(*session_, name, v1::POSITION_KIND_COORDINATES);
}

MotionResult Places::move_to(const std::string& name, std::stop_token stop) const {
  v1::MoveToPositionRequest request;
  request.set_position(place_name(*session_, name));
  return session_->finish(session_->services().positions, &PositionStub::MoveToPosition, request, std::move(stop));
}

void Places::erase(const std::string& name) const {
  v1::DeletePositionRequest request;
  request.set_position(place_name(*session_, name));
  session_->act(session_->services().positions, &PositionStub::DeletePosition, request);
}

std::map<std::string, std::vector<Position>> Places::list() const {
  v1::ListPositionsRequest request;
  request.set_device(session_->device());
  request.set_page_size(kPage);
  std::map<std::string, std::vector<Position>> places;
  do {
    const auto page = session_->connection().ask(session_->services().positions, &PositionStub::ListPositions, request);
    for (const v1::Position& place : page.positions()) {
      std::vector<Position>& coordinates = places[client::last_part(place.name())];
      for (const v1::PositionCoordinate& one : place.coordinates()) {
        coordinates.push_back(
            {client::axis_name(one.name(), one.axis()), one.position(), client::unit_text(one.unit()), one.pulses()});
      }
    }
    request.set_page_token(page.next_page_token());
  } while (!request.page_token().empty());
  return places;
}

}  // namespace axisgate
