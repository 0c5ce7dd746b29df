// Amounts, hints and errors.
#include <gmock/gmock.h>

#include <cmath>
#include <type_traits>

#include "axisgate/axisgate.h"
#include "clients/cpp/src/amounts.h"
#include "clients/cpp/src/hints.h"

namespace axisgate::client {
namespace {

using namespace axisgate::literals;

static_assert(!std::is_convertible_v<double, Distance>);
static_assert(!std::is_convertible_v<int, Distance>);

TEST(Amounts, AreExactAsTextsLiteralsAndWholeNumbers) {
  EXPECT_EQ(to_message(1.50_mm).mm(), "1.50");
  EXPECT_EQ(to_message(mm("-0.25")).mm(), "-0.25");
  EXPECT_EQ(to_message(um(200)).um(), "200");
  EXPECT_EQ(to_message(pulses(-5)).pulses(), -5);
  EXPECT_EQ(to_message(pulses("+7")).pulses(), 7);
  EXPECT_EQ(to_message((-2_nm).per_second()).nm_per_s(), "-2");
}

TEST(Amounts, AreRoundedAsFloatingPointNumbers) {
  const v1::FloatingAmount amount = to_message(mm(0.1 + 0.2)).floating();
  EXPECT_EQ(amount.value(), 0.1 + 0.2);
  EXPECT_EQ(amount.unit(), v1::UNIT_MILLIMETERS);
  EXPECT_EQ(amount.rounding(), v1::ROUNDING_NEAREST);
}

TEST(Amounts, ThatAreNoneAreRefusedAtOnce) {
  EXPECT_THROW(mm(std::nan("")), InvalidArgument);
  EXPECT_THROW(mm(INFINITY), InvalidArgument);
  EXPECT_THROW(mm("1,5"), InvalidArgument);
  EXPECT_THROW(mm(""), InvalidArgument);
  EXPECT_THROW(Distance("1", "inch"), InvalidArgument);
  EXPECT_THROW(to_message(pulses("1.5")), InvalidArgument);
}

TEST(Amounts, HaveAnOpposite) {
  EXPECT_EQ((-mm("-1.5")).text(), "1.5 mm");
  EXPECT_EQ((-mm("+1.5")).text(), "-1.5 mm");
  EXPECT_EQ((-um(0.5)).per_second().text(), "-0.5 um/s");
}

TEST(Hints, NameFunctionsOfThisPackage) {
  EXPECT_EQ(with_functions("call `ChangeSettings` with `excited`", 2), "call `stage.switch_motor(\"2\", true)`");
  EXPECT_EQ(with_functions("`AcquireLease` or `Home`", std::nullopt),
            "`stage.lease({.axes = {axis}})` or `stage.home({axis})`");
}

TEST(Errors, SayTheReasonTheMessageAndTheHint) {
  EXPECT_STREQ(Refused({.reason = "NOT_HOMED", .message = "home it.", .hint = "home()"}).what(),
               "NOT_HOMED: home it. (home())");
}

TEST(Status, HasNoAxesBeforeTheControllerAnswers) {
  Status status;
  EXPECT_THROW(status.axis("x"), Unavailable);
  status.axes.emplace_back().name = "y";
  EXPECT_THROW(status.axis("x"), InvalidArgument);
  EXPECT_EQ(status.axis("y").name, "y");
}

}  // namespace
}  // namespace axisgate::client
