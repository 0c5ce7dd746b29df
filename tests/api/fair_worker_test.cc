// Tests of the order in which callers' long tasks run.
#include "server/api/request/fair_worker.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <future>
#include <string>
#include <vector>

namespace axisgate::api {
namespace {

TEST(AFairWorker, TakesOneTaskOfEachInTurn) {
  std::vector<std::string> order;
  std::promise<void> first_runs, all_are_there;
  {
    FairWorker worker;
    worker.post("anna", [&] {
      first_runs.set_value();
      all_are_there.get_future().wait();
    });
    first_runs.get_future().wait();
    const auto post = [&](const std::string& who, const std::string& what) {
      worker.post(who, [&order, what] { order.push_back(what); });
    };
    post("bert", "bert 1");
    post("bert", "bert 2");
    post("bert", "bert 3");
    post("anna", "anna 1");
    post("cleo", "cleo 1");
    all_are_there.set_value();
    worker.join();
    post("anna", "too late");
  }
  EXPECT_THAT(order, testing::ElementsAre("bert 1", "anna 1", "cleo 1", "bert 2", "bert 3"))
      << "it ends when all have run";
}

}  // namespace
}  // namespace axisgate::api
