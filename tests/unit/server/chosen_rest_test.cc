// Place at which a job of the spool continues after a person has chosen a line.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "device/rml1/machine/profile.h"
#include "device/rml1/model.h"
#include "server/devices/spooled_jobs.h"
#include "tests/paths/paths.h"
#include "tests/unit/server/spool_bed.h"

namespace axisgate::server {
namespace {

using testing::HasSubstr;

// The second of three parts sets Z0 in its third line.
constexpr std::string_view kFirst = "PA;PU1,1;\nPU2,2;\n", kSecond = "PU1,1;\nPU2,2;\n!ZO-10;\nPU3,3;\n";

class ChosenRest : public spool_test::SpoolBed {
 protected:
  void SetUp() override {
    config_.model = std::make_shared<const rml1::MillModel>(
        "mdx-20", "", *rml1::load_profile(paths::in_project("deploy/mills/mdx-20.toml")),
        std::vector<rml1::KnownMachine>());
    job_.number = upload(std::string(kFirst) + std::string(kSecond) + "PU9,9;")->id;
    job_.parts = {{"T1", kFirst.size()}, {"T2", kFirst.size() + kSecond.size()}, {"T1", 52}};
    go_to_part(job_, 1);
  }
  // `sent`: least and most bytes of the part that may have been sent; nullopt if unknown.
  std::string chosen(std::optional<jobs::WrittenRange> sent, std::uint64_t line) {
    job_.written.reset();
    if (sent) job_.written = jobs::WrittenRange{kFirst.size() + sent->least, kFirst.size() + sent->most};
    const Result<jobs::Place> place = chosen_rest(*spool_, "mill", config_, job_, line, 1);
    return place ? fmt::format("{}:{}", place->line, place->column) : place.error().message;
  }

  MillConfig config_;
  jobs::Job job_;
};

TEST_F(ChosenRest, IsNotBeforeWhatTheMillMayHaveDoneAndNothingGivesBack) {
  EXPECT_EQ(chosen({{0, 14}}, 2), "2:1") << "it was not sent";
  EXPECT_THAT(chosen({{0, 22}}, 2), HasSubstr("the job sets Z0 (!ZO)"));
  EXPECT_THAT(chosen(std::nullopt, 2), HasSubstr("the job sets Z0 (!ZO)"));
}

TEST_F(ChosenRest, SaysWhereWhatWasExecutedEnds) {
  EXPECT_THAT(chosen({{7, 7}}, 0), HasSubstr("what the mill has executed of it ends at line 2, column 1"));
  config_.sending.flow_control = true;
  config_.sending.buffer = 4;
  EXPECT_THAT(chosen({{7, 16}}, 0), HasSubstr("ends at line 1, column 4, or later, up to line 3, column 3"))
      << "of the 7 bytes that the mill was sent, 4 may be in its buffer";
  config_.sending.buffer = 1024;
  EXPECT_THAT(chosen({{7, 16}}, 0), HasSubstr("ends at line 1, column 1, or later, up to line 3, column 3"));
}

TEST_F(ChosenRest, NamesNothingThatAMillWithoutFlowControlMayHaveLost) {
  config_.sending.flow_control = false;
  config_.sending.buffer = 4;
  EXPECT_THAT(chosen({{7, 16}}, 0), HasSubstr("ends at line 1, column 1, or later, up to line 3, column 3"));
}

TEST_F(ChosenRest, SaysWhatAnAbortHasLeft) {
  job_.executed = jobs::PlaceRange{{7, 2, 1}, {14, 3, 1}};
  EXPECT_THAT(chosen(std::nullopt, 0), HasSubstr("ends at line 2, column 1, or later, up to line 3, column 1"));
  EXPECT_EQ(chosen(std::nullopt, 2), "2:1") << "Z0 was not sent";
}

}  // namespace
}  // namespace axisgate::server
