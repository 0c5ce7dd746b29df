// Every phase of the link with every event, typed from the table in device/shot/README.md.
#include "device/shot/line/link.h"

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <string>
#include <string_view>

namespace axisgate::shot::link_test {
namespace {

// Columns: port_opened, lost, flooded, stop_waits, identified, answer_doubted, barrier_passed, handshake_passed,
// restart_suspected, same_controller. "-" is impossible.
const std::map<std::string, std::array<std::string, 10>> kTable = {
    {"closed", {"identifying", "closed", "-", "reopening", "-", "-", "-", "-", "-", "-"}},
    {"reopening", {"identifying", "closed", "-", "-", "-", "-", "-", "-", "-", "-"}},
    {"babbling", {"listening", "closed", "-", "reopening", "-", "-", "-", "-", "-", "-"}},
    {"identifying", {"-", "closed", "babbling", "-", "handshaking", "-", "-", "-", "-", "-"}},
    {"listening", {"-", "closed", "babbling", "-", "handshaking", "-", "-", "-", "-", "-"}},
    {"handshaking", {"-", "closed", "babbling", "-", "-", "handshake_doubtful", "-", "up", "-", "-"}},
    {"handshake_doubtful", {"-", "closed", "babbling", "-", "-", "-", "handshaking", "doubtful", "-", "-"}},
    {"up", {"-", "closed", "babbling", "-", "-", "doubtful", "-", "-", "restart_suspected", "-"}},
    {"doubtful", {"-", "closed", "babbling", "-", "-", "-", "up", "-", "restart_doubtful", "-"}},
    {"restart_suspected", {"-", "closed", "babbling", "-", "-", "restart_doubtful", "-", "-", "-", "up"}},
    {"restart_doubtful", {"-", "closed", "babbling", "-", "-", "-", "restart_suspected", "-", "-", "doubtful"}},
};

TEST(LinkTable, EachPairLeadsWhereThePageSays) {
  int illegal = 0;
  for (std::size_t phase = 0; phase < kLinkPhases; ++phase) {
    const auto from = static_cast<LinkPhase>(phase);
    const auto& row = kTable.at(std::string(name(from)));
    for (std::size_t event = 0; event < kLinkEvents; ++event) {
      const auto to = next(from, static_cast<LinkEvent>(event));
      EXPECT_EQ(to ? std::string(name(*to)) : "-", row[event]) << name(from) << ", event " << event;
      illegal += to ? 0 : 1;
    }
  }
  EXPECT_EQ(illegal, 72);
}

TEST(LinkTable, EachEventHasTheNameOfItsColumn) {
  constexpr std::array<std::string_view, 10> columns = {
      "port_opened",    "lost",           "flooded",          "stop_waits",        "identified",
      "answer_doubted", "barrier_passed", "handshake_passed", "restart_suspected", "same_controller"};
  for (std::size_t event = 0; event < columns.size(); ++event) {
    EXPECT_EQ(name(static_cast<LinkEvent>(event)), columns[event]);
  }
}

TEST(Link, AnEventThatCannotBeLeavesThePhase) {
  Link link;
  EXPECT_FALSE(link.happened(LinkEvent::handshake_passed));
  EXPECT_EQ(link.phase(), LinkPhase::closed);
}

TEST(Link, WhatCallersAreShown) {
  const std::map<LinkPhase, LinkState> all = {
      {LinkPhase::closed, LinkState::down},
      {LinkPhase::reopening, LinkState::down},
      {LinkPhase::babbling, LinkState::babbling},
      {LinkPhase::listening, LinkState::babbling},
      {LinkPhase::identifying, LinkState::connecting},
      {LinkPhase::handshaking, LinkState::connecting},
      {LinkPhase::handshake_doubtful, LinkState::connecting},
      {LinkPhase::up, LinkState::up},
      {LinkPhase::doubtful, LinkState::doubtful},
      {LinkPhase::restart_suspected, LinkState::doubtful},
      {LinkPhase::restart_doubtful, LinkState::doubtful},
  };
  ASSERT_EQ(all.size(), kLinkPhases);
  for (const auto& [phase, state] : all) EXPECT_EQ(shown(phase), state) << name(phase);
}

TEST(Link, WhatAPhaseMeansForTheLine) {
  Link link;
  const auto after = [&link](LinkEvent event) {
    EXPECT_TRUE(link.happened(event)) << name(event) << " in " << name(link.phase());
    return std::string(link.port_open() ? "open " : "shut ") + (link.trusted() ? "trusted " : "") +
           (link.restart_suspected() ? "suspected" : "");
  };
  EXPECT_EQ(after(LinkEvent::stop_waits), "shut ");
  EXPECT_EQ(after(LinkEvent::port_opened), "open ");
  EXPECT_EQ(after(LinkEvent::identified), "open ");
  EXPECT_EQ(after(LinkEvent::answer_doubted), "open ");
  EXPECT_EQ(after(LinkEvent::barrier_passed), "open ");
  EXPECT_EQ(after(LinkEvent::handshake_passed), "open trusted ");
  EXPECT_EQ(after(LinkEvent::answer_doubted), "open trusted ");
  EXPECT_EQ(after(LinkEvent::restart_suspected), "open trusted suspected");
  EXPECT_EQ(after(LinkEvent::barrier_passed), "open trusted suspected");
  EXPECT_EQ(after(LinkEvent::same_controller), "open trusted ");
  EXPECT_EQ(after(LinkEvent::lost), "shut ");
}

}  // namespace
}  // namespace axisgate::shot::link_test
