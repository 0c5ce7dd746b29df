// Every phase of an exchange with every event, typed from the table in device/shot/README.md.
#include "device/shot/line/exchange.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "device/shrc203/command/command_table.h"
#include "tests/unit/core/transition_table.h"

namespace axisgate::shot::exchange_test {
namespace {

using testing_tables::Table;

TEST(ExchangeTable, EachPairLeadsWhereThePageSays) {
  const Table table = {
      {"idle", {"in_flight", "after_question", "-", "-", "-", "in_doubt", "-", "idle"}},
      {"after_question", {"-", "-", "in_flight", "-", "idle", "in_doubt", "-", "-"}},
      {"in_flight", {"-", "-", "-", "closing", "idle", "in_doubt", "-", "-"}},
      {"closing", {"-", "-", "-", "closing", "idle", "in_doubt", "-", "-"}},
      {"in_doubt", {"-", "-", "-", "-", "-", "-", "idle", "idle"}},
  };
  const int illegal = testing_tables::illegal_pairs<ExchangePhase, ExchangeEvent>(
      table, kExchangePhases,
      {"written", "written_after_question", "question_answered", "number_received", "ended", "doubted", "resolved",
       "line_closed"},
      [](ExchangePhase phase, ExchangeEvent event) { return next(phase, event); });
  EXPECT_EQ(illegal, 25);
}

class ExchangeTest : public testing::Test, public Violations {
 protected:
  void illegal(std::string_view machine, std::string_view state, std::string_view event) override {
    reports.push_back(std::string(machine) + ": " + std::string(state) + ", " + std::string(event));
  }
  static InFlight line() { return {std::make_shared<Waiting>(), TimePoint{}, TimePoint{}, 7}; }
  std::unique_ptr<Barrier> barrier() {
    return std::make_unique<Barrier>(
        shrc203::model(), "G:1", Barrier::Limits{}, outstanding, [](const Identity&) { return true; },
        [](std::string_view, TimePoint) {});
  }

  OutstandingAnswers outstanding;
  std::vector<std::string> reports;
  Exchange exchange{*this};
};

TEST_F(ExchangeTest, HasALineOrABarrierOnlyInThePhasesOfOne) {
  EXPECT_EQ(exchange.in_flight(), nullptr);
  EXPECT_EQ(exchange.barrier(), nullptr);
  exchange.written(line(), true);
  EXPECT_EQ(exchange.phase(), ExchangePhase::after_question);
  ASSERT_NE(exchange.in_flight(), nullptr);
  exchange.question_answered();
  exchange.number_received(2);
  exchange.number_received(1);
  EXPECT_TRUE(exchange.closing());
  EXPECT_EQ(exchange.in_flight()->numbers, (std::vector{2, 1}));
  exchange.doubted(barrier(), Doubted{exchange.in_flight()->waiting, {}});
  EXPECT_EQ(exchange.in_flight(), nullptr);
  EXPECT_NE(exchange.barrier(), nullptr);
  EXPECT_TRUE(exchange.awaits_result());
  EXPECT_TRUE(exchange.resolved().has_value());
  EXPECT_TRUE(exchange.idle());
  EXPECT_EQ(exchange.barrier(), nullptr);
  EXPECT_FALSE(exchange.awaits_result());
  EXPECT_TRUE(reports.empty());
}

TEST_F(ExchangeTest, ABarrierOfAConnectHoldsBackNoResult) {
  exchange.doubted(barrier(), std::nullopt);
  EXPECT_FALSE(exchange.awaits_result());
  EXPECT_FALSE(exchange.line_closed().has_value());
  EXPECT_TRUE(exchange.idle());
}

TEST_F(ExchangeTest, AnIllegalEventIsReportedAndChangesNothing) {
  EXPECT_FALSE(exchange.ended().has_value());
  exchange.number_received(1);
  exchange.written(line(), false);
  InFlight second = line();
  second.exchange = 8;
  exchange.written(std::move(second), false);
  EXPECT_EQ(exchange.in_flight()->exchange, 7u);
  EXPECT_EQ(reports, (std::vector<std::string>{"exchange: idle, ended", "exchange: idle, number_received",
                                               "exchange: in_flight, written"}));
  EXPECT_EQ(exchange.ended()->exchange, 7u);
}

}  // namespace
}  // namespace axisgate::shot::exchange_test
