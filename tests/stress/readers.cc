#include "tests/stress/readers.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>

#include "device/link/clock.h"

namespace axisgate::stress {
namespace {

constexpr std::size_t kPortion = 200;

std::uint64_t publish_fact(server::EventBus& bus) {
  const TimePoint now = monotonic_now();
  return bus.publish("nobody", stage::StopRequested{}, server::to_wall(now));
}

void take_a_breath() { std::this_thread::sleep_for(std::chrono::microseconds(100)); }

}  // namespace

QuickReader::QuickReader(server::EventBus& bus) : bus_(bus), subscription_(bus.subscribe([this] { read(); })) {}

void QuickReader::read() {
  for (;;) {
    const server::EventBus::Reading reading = bus_.read(next_, kPortion);
    ASSERT_FALSE(reading.compacted) << "at revision " << next_;
    if (reading.facts.empty()) return;
    std::uint64_t expected = next_;
    for (const auto& record : reading.facts) {
      EXPECT_EQ(record->revision, expected++);
      follow(*record);
    }
    next_ = reading.next;
  }
}

void QuickReader::follow(const server::FactRecord& record) {
  const auto* changed = std::get_if<stage::MotionChanged>(&record.fact);
  if (changed == nullptr) return;
  const auto [known, begun] = motions_.try_emplace({record.device, changed->motion.id}, changed->motion.state);
  if (begun) {
    EXPECT_EQ(changed->motion.state, stage::MotionState::queued) << record.device << " " << changed->motion.id;
    ++motions_open_;
    return;
  }
  EXPECT_GT(changed->motion.state, known->second) << record.device << " " << changed->motion.id;
  EXPECT_FALSE(stage::is_outcome(known->second)) << record.device << " " << changed->motion.id;
  known->second = changed->motion.state;
  if (stage::is_outcome(known->second)) --motions_open_;
}

bool QuickReader::wait_until_all_ended() const {
  const TimePoint limit = monotonic_now() + std::chrono::minutes(1);
  while (motions_open_ > 0 && monotonic_now() < limit) take_a_breath();
  return motions_open_ == 0;
}

StateReader::StateReader(Bench& bench, std::size_t device)
    : states_(bench.device(device).newest_state()),
      device_(device),
      subscription_(states_.subscribe([this] { read(); })) {}

void StateReader::read() {
  const auto [state, version] = states_.get();
  EXPECT_GE(version, version_);
  version_ = version;
  if (!state->serial_number.empty()) {
    EXPECT_EQ(state->serial_number, serial_number(device_));
  }
}

int read_slowly(server::EventBus& bus, const std::atomic<bool>& ended) {
  int told = 0;
  std::uint64_t next = 1;
  while (!ended || next <= bus.newest_revision()) {
    if (!ended && bus.newest_revision() < next + server::EventBus::kFactsKept + kPortion) {
      take_a_breath();
      continue;
    }
    const server::EventBus::Reading reading = bus.read(next, kPortion);
    if (reading.compacted) {
      ++told;
      EXPECT_GT(reading.next, next);
    }
    for (const auto& record : reading.facts) EXPECT_EQ(record->revision, next++);
    next = reading.next;
  }
  return told;
}

void publish_facts(server::EventBus& bus, const QuickReader& reader, int facts) {
  const TimePoint limit = monotonic_now() + std::chrono::minutes(2);
  for (int i = 0; i < facts; ++i) {
    const std::uint64_t revision = publish_fact(bus);
    while (revision > reader.next() + server::EventBus::kFactsKept / 4) {
      ASSERT_LT(monotonic_now(), limit) << "the quick reader is not woken";
      take_a_breath();
    }
  }
}

void come_and_go(server::Gateway& gateway, int times) {
  const TimePoint limit = monotonic_now() + std::chrono::minutes(2);
  auto fired = std::make_shared<std::atomic<int>>(0);
  for (int i = 0; i < times; ++i) {
    gateway.timeouts().after(std::chrono::microseconds(i % 500), [fired] { ++*fired; });
    std::atomic<int> woken = 0;
    const auto subscription = gateway.events().subscribe([&] { ++woken; });
    for (int due = 1; due <= i % 3; ++due) {
      publish_fact(gateway.events());
      while (woken < due && monotonic_now() < limit) take_a_breath();
    }
    // Subscriptions end before, during or after the next wake-up.
    const std::uint64_t revision = publish_fact(gateway.events());
    for (int look = 0; look <= i % 300; ++look) EXPECT_GE(gateway.events().newest_revision(), revision);
  }
  while (*fired != times && monotonic_now() < limit) take_a_breath();
  EXPECT_EQ(*fired, times);
}

}  // namespace axisgate::stress
