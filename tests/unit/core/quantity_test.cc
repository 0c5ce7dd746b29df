#include "device/core/quantity.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace axisgate::quantity_test {
namespace {

const Scale k10Nanometers = {{10, 0}, false};
const Scale k1Nanometer = {{1, 0}, false};
const Scale kMicrodegree = {{1, 0}, true};

template <class T>
Reason reason_of(const Result<T>& result) {
  return result ? Reason::unspecified : result.error().reason;
}

std::string read_back(std::string_view text) {
  const auto value = parse_decimal(text);
  return value ? to_string(*value) : std::string(name(value.error().reason));
}

Result<std::int64_t> pulses_of(std::string_view text, const Scale& scale) {
  return parse_quantity(text, Unit::pulses).and_then([&](const Quantity& quantity) {
    return to_pulses(quantity, scale);
  });
}

std::string text_of(std::int64_t count, Unit unit, const Scale& scale) {
  const auto value = from_pulses(count, unit, scale);
  return value ? to_string(*value) : std::string(name(value.error().reason));
}

TEST(Decimal, IsExact) {
  EXPECT_EQ(parse_decimal("0.001"), (Decimal{1, 3}));
  EXPECT_EQ(parse_decimal("-12.5"), (Decimal{-125, 1}));
  EXPECT_EQ(parse_decimal("+1000"), (Decimal{1000, 0}));
  EXPECT_EQ(parse_decimal(".5"), (Decimal{5, 1}));
}

TEST(Decimal, EqualNumbersCompareEqual) {
  EXPECT_EQ(parse_decimal("010.00"), (Decimal{10, 0}));
  EXPECT_EQ(parse_decimal("-0.0"), (Decimal{0, 0}));
}

TEST(Decimal, IsWrittenAsPeopleReadIt) {
  EXPECT_EQ(read_back("0.001"), "0.001");
  EXPECT_EQ(read_back("-0.05"), "-0.05");
  EXPECT_EQ(read_back("-12.50"), "-12.5");
  EXPECT_EQ(read_back("+1000"), "1000");
  EXPECT_EQ(to_string({150, 2}), "1.50");
  EXPECT_EQ(to_string({std::numeric_limits<std::int64_t>::min(), 0}), "-9223372036854775808");
}

TEST(Decimal, Takes18Digits) {
  EXPECT_EQ(read_back("999999999999999999"), "999999999999999999");
  EXPECT_EQ(read_back("-0.000000000000000001"), "-0.000000000000000001");
  EXPECT_EQ(read_back("1234567890.12345678"), "1234567890.12345678");
  EXPECT_EQ(read_back("0000000000000000000000001.50000000000000000000"), "1.5");
  EXPECT_EQ(read_back("1000000000000000000"), "OUT_OF_RANGE");
  EXPECT_EQ(read_back("0.0000000000000000001"), "OUT_OF_RANGE");
  EXPECT_EQ(read_back("99999999999999999999999999999999999999999"), "OUT_OF_RANGE");
}

TEST(Decimal, RefusesWhatIsNoNumber) {
  for (const char* text : {"", "+", "-", ".", "5.", "1.2.3", "+-5", "1e", "e3", "1e+", "1e1.5", "1e1000", "0x10", " 5",
                           "5 ", "1,000", "five", "inf"}) {
    EXPECT_EQ(read_back(text), "INVALID_REQUEST") << '"' << text << '"';
  }
}

TEST(Decimal, TakesAnExponent) {
  EXPECT_EQ(read_back("1e3"), "1000");
  EXPECT_EQ(read_back("1e-05"), "0.00001");  // as Python writes 1e-5
  EXPECT_EQ(read_back("-1.50E+2"), "-150");
  EXPECT_EQ(read_back("2.5e-3"), "0.0025");
  EXPECT_EQ(read_back("0e999"), "0");
  EXPECT_EQ(read_back("1e17"), "100000000000000000");
  EXPECT_EQ(read_back("1e18"), "OUT_OF_RANGE");
  EXPECT_EQ(read_back("1e-18"), "0.000000000000000001");
  EXPECT_EQ(read_back("1e-19"), "OUT_OF_RANGE");
}

std::string of(double value, bool approximate) {
  const Result<Decimal> decimal = decimal_of(value, approximate);
  return decimal ? to_string(*decimal) : std::string(name(decimal.error().reason));
}

TEST(Decimal, OfADoubleIsTheShortestThatReadsBackAsIt) {
  EXPECT_EQ(of(1.5, false), "1.5");
  EXPECT_EQ(of(0.1 + 0.2, false), "0.30000000000000004");
  EXPECT_EQ(of(1e-5, false), "0.00001");
  EXPECT_EQ(of(-0.0, false), "0");
  EXPECT_EQ(of(1e300, true), "OUT_OF_RANGE");
  EXPECT_EQ(of(1.2345678901234567e-9, false), "OUT_OF_RANGE");
  EXPECT_EQ(of(1.2345678901234567e-9, true), "0.000000001234568");
  EXPECT_EQ(of(5e-324, true), "0");
  EXPECT_EQ(of(std::numeric_limits<double>::infinity(), true), "INVALID_REQUEST");
  EXPECT_EQ(of(std::numeric_limits<double>::quiet_NaN(), true), "INVALID_REQUEST");
}

TEST(Decimal, SaysWhatIsWrongWithoutRepeatingControlBytes) {
  const auto value = parse_decimal("5\n");
  ASSERT_FALSE(value);
  EXPECT_EQ(value.error().message, "\"5\\n\" is not a number");
}

TEST(Unit, TakesTheSpellingsPeopleUse) {
  for (const char* text : {"p", "pls", "pulse", "pulses"}) EXPECT_EQ(parse_unit(text), Unit::pulses) << text;
  EXPECT_EQ(parse_unit("nm"), Unit::nanometers);
  for (const char* text : {"um", "\xC2\xB5m", "\xCE\xBCm"}) EXPECT_EQ(parse_unit(text), Unit::micrometers) << text;
  EXPECT_EQ(parse_unit("mm"), Unit::millimeters);
  for (const char* text : {"deg", "degree", "degrees", "\xC2\xB0"}) EXPECT_EQ(parse_unit(text), Unit::degrees) << text;
}

TEST(Unit, ItsSymbolIsReadBack) {
  for (const Unit unit : {Unit::pulses, Unit::nanometers, Unit::micrometers, Unit::millimeters, Unit::degrees}) {
    EXPECT_EQ(parse_unit(symbol(unit)), unit) << symbol(unit);
  }
}

TEST(Unit, RefusesOthersAndNamesItsOwn) {
  const auto unit = parse_unit("inch");
  ASSERT_FALSE(unit);
  EXPECT_EQ(unit.error().reason, Reason::unknown_unit);
  EXPECT_EQ(unit.error().message, "\"inch\" is not a unit");
  EXPECT_EQ(unit.error().hint, "Use pulse, nm, um, mm or deg.");
  EXPECT_EQ(reason_of(parse_unit("MM")), Reason::unknown_unit);
}

TEST(Quantity, HasANumberAndAUnit) {
  const auto quantity = parse_quantity("-200um", Unit::millimeters);
  ASSERT_TRUE(quantity);
  EXPECT_EQ(quantity->value, (Decimal{-200, 0}));
  EXPECT_EQ(quantity->unit, Unit::micrometers);
}

TEST(Quantity, NeedsADecimalPoint) {
  for (const char* text : {"12,5um", "12,5", "-1,000.5mm", ",5um"}) {
    const auto quantity = parse_quantity(text, Unit::millimeters);
    ASSERT_FALSE(quantity) << text;
    EXPECT_EQ(quantity.error().reason, Reason::invalid_request);
    EXPECT_EQ(quantity.error().message, '"' + std::string(text) + "\" has a comma where a decimal point is needed");
  }
  EXPECT_EQ(parse_speed("2,5mm/s", Unit::millimeters).error().message,
            "\"2,5mm\" has a comma where a decimal point is needed");
}

TEST(Quantity, TakesTheFallbackWhenItHasNoUnit) {
  const auto quantity = parse_quantity("+1.5", Unit::millimeters);
  ASSERT_TRUE(quantity);
  EXPECT_EQ(quantity->value, (Decimal{15, 1}));
  EXPECT_EQ(quantity->unit, Unit::millimeters);
}

TEST(Quantity, TakesAnExponentBeforeTheUnit) {
  const auto quantity = parse_quantity("-2.5e-3mm", Unit::pulses);
  ASSERT_TRUE(quantity);
  EXPECT_EQ(quantity->value, (Decimal{-25, 4}));
  EXPECT_EQ(quantity->unit, Unit::millimeters);
}

TEST(Quantity, RefusesWhatItCannotRead) {
  for (const char* text : {"", "mm", "five", "--5mm", "5.mm", "mm5"}) {
    EXPECT_EQ(reason_of(parse_quantity(text, Unit::pulses)), Reason::invalid_request) << '"' << text << '"';
  }
  for (const char* text : {"5parsec", "1e", "1emm", "5 mm", "5mm ", "5mm\r", "5mm/min"}) {
    EXPECT_EQ(reason_of(parse_quantity(text, Unit::pulses)), Reason::unknown_unit) << '"' << text << '"';
  }
  EXPECT_EQ(reason_of(parse_quantity("1000000000000000000mm", Unit::pulses)), Reason::out_of_range);
}

TEST(Quantity, IsNotASpeed) {
  const auto quantity = parse_quantity("2mm/s", Unit::pulses);
  ASSERT_FALSE(quantity);
  EXPECT_EQ(quantity.error().reason, Reason::invalid_request);
  EXPECT_EQ(quantity.error().message, "\"2mm/s\" is a speed where a distance or position is wanted");
  EXPECT_FALSE(quantity.error().hint.empty());
}

TEST(Speed, MayNameTheSecond) {
  for (const char* text : {"2mm/s", "2mm", "2/s", "2"}) {
    const auto speed = parse_speed(text, Unit::millimeters);
    ASSERT_TRUE(speed) << text;
    EXPECT_EQ(speed->value, (Decimal{2, 0})) << text;
    EXPECT_EQ(speed->unit, Unit::millimeters) << text;
  }
  EXPECT_FALSE(parse_speed("2mm/s/s", Unit::millimeters));
  EXPECT_FALSE(parse_speed("/s", Unit::millimeters));
}

// Manual 67) M:, setting ranges: 1,000 pulses of 1 nm are N1000, U1 or M0.001; 1,000 of 0.000001 degrees are D0.001.
TEST(ToPulses, AgreesWithTheManualsExamples) {
  EXPECT_EQ(pulses_of("1000nm", k1Nanometer), 1000);
  EXPECT_EQ(pulses_of("1um", k1Nanometer), 1000);
  EXPECT_EQ(pulses_of("0.001mm", k1Nanometer), 1000);
  EXPECT_EQ(pulses_of("0.001deg", kMicrodegree), 1000);
}

TEST(ToPulses, IsExactAtOtherScales) {
  EXPECT_EQ(pulses_of("5mm", k10Nanometers), 500000);
  EXPECT_EQ(pulses_of("-200um", k10Nanometers), -20000);
  EXPECT_EQ(pulses_of("-0.00001mm", k10Nanometers), -1);
  EXPECT_EQ(pulses_of("1mm", {{125, 1}, false}), 80000);
  EXPECT_EQ(pulses_of("0.1nm", {{5, 2}, false}), 2);
  EXPECT_EQ(pulses_of("-7", k10Nanometers), -7);
  EXPECT_EQ(pulses_of("0mm", k10Nanometers), 0);
}

TEST(ToPulses, RefusesToRoundAndNamesTheNearest) {
  const auto count = pulses_of("5nm", k10Nanometers);
  ASSERT_FALSE(count);
  EXPECT_EQ(count.error().reason, Reason::not_representable);
  EXPECT_EQ(count.error().message, "\"5nm\" is not a whole number of pulses of 10 nm; the nearest are 0nm and 10nm");
  EXPECT_FALSE(count.error().hint.empty());
}

TEST(ToPulses, NamesTheNearestBelowZeroAndInTheUnitAsked) {
  EXPECT_EQ(pulses_of("-0.000015mm", k10Nanometers).error().message,
            "\"-0.000015mm\" is not a whole number of pulses of 10 nm; the nearest are -0.00002mm and -0.00001mm");
  EXPECT_EQ(pulses_of("0.0000005deg", kMicrodegree).error().message,
            "\"0.0000005deg\" is not a whole number of pulses of 0.000001 deg; the nearest are 0deg and 0.000001deg");
  EXPECT_EQ(pulses_of("1.5", k10Nanometers).error().message,
            "\"1.5pulse\" is not a whole number of pulses; the nearest are 1pulse and 2pulse");
  EXPECT_EQ(reason_of(pulses_of("0.000000000000000001mm", k10Nanometers)), Reason::not_representable);
}

TEST(ToPulses, NamesTheNearestInPulsesWhereTheyHaveTooManyDigits) {
  EXPECT_EQ(pulses_of("0.000000000000000001mm", {{7, 13}, false}).error().message,
            "\"0.000000000000000001mm\" is not a whole number of pulses of 0.0000000000007 nm; the nearest are 1pulse "
            "and 2pulse");
}

TEST(ToPulses, SpeedsAreSpokenOfAsSpeeds) {
  EXPECT_EQ(to_pulses_per_second({{2, 0}, Unit::millimeters}, k10Nanometers), 200'000);
  EXPECT_EQ(to_pulses_per_second({{5, 3}, Unit::degrees}, kMicrodegree), 5000);
  const auto between = to_pulses_per_second({{25, 0}, Unit::nanometers}, k10Nanometers);
  ASSERT_FALSE(between);
  EXPECT_EQ(between.error().reason, Reason::not_representable);
  EXPECT_EQ(between.error().message,
            "\"25nm/s\" is not a whole number of pulses of 10 nm a second; the nearest are 20nm/s and 30nm/s");
  const auto slow = to_pulses_per_second({{5, 3}, Unit::micrometers}, k10Nanometers);
  ASSERT_FALSE(slow);
  EXPECT_EQ(slow.error().message,
            "\"0.005um/s\" is not a whole number of pulses of 10 nm a second; the nearest is 0.01um/s");
  EXPECT_EQ(slow.error().hint, "Ask for this.");
}

TEST(ToPulses, RoundsToTheNearestOnlyWhenAsked) {
  const auto rounded = [](std::int64_t nanometers) {
    return to_pulses({.value = {nanometers, 0}, .unit = Unit::nanometers, .nearest = true}, k10Nanometers);
  };
  EXPECT_EQ(rounded(24), 2);
  EXPECT_EQ(rounded(25), 3);
  EXPECT_EQ(rounded(-24), -2);
  EXPECT_EQ(rounded(-25), -3);
  EXPECT_EQ(rounded(-26), -3);
  EXPECT_EQ(rounded(30), 3);
  EXPECT_EQ(rounded(-4), 0);
  EXPECT_EQ(rounded(9'999'999'994), 999'999'999);
  EXPECT_FALSE(rounded(9'999'999'996));
}

// Manual 67) M:, y: 0 to 999,999,999 with a sign.
TEST(ToPulses, TakesNineDigitsEitherWay) {
  EXPECT_EQ(pulses_of("999999999", k10Nanometers), 999999999);
  EXPECT_EQ(pulses_of("-999999999", k10Nanometers), -999999999);
  EXPECT_EQ(pulses_of("9999.99999mm", k10Nanometers), 999999999);
  EXPECT_EQ(reason_of(pulses_of("1000000000", k10Nanometers)), Reason::out_of_range);
  EXPECT_EQ(reason_of(pulses_of("-1000000000", k10Nanometers)), Reason::out_of_range);
  EXPECT_EQ(reason_of(pulses_of("999999999.5", k10Nanometers)), Reason::out_of_range);
  EXPECT_EQ(reason_of(pulses_of("-999999999.5", k10Nanometers)), Reason::out_of_range);
}

TEST(ToPulses, SaysHowFarTheRangeGoes) {
  const auto count = pulses_of("10000mm", k10Nanometers);
  ASSERT_FALSE(count);
  EXPECT_EQ(count.error().message, "\"10000mm\" is beyond the 999,999,999 pulses that a command can carry");
  EXPECT_EQ(count.error().hint, "At 10 nm a pulse that is 9999.99999mm either way.");
}

TEST(ToPulses, SurvivesTheLargestNumbers) {
  const Scale tiny = {{1, 18}, false};
  const Scale huge = {{999'999'999'999'999'999, 0}, false};
  EXPECT_EQ(reason_of(pulses_of("999999999999999999mm", tiny)), Reason::out_of_range);
  EXPECT_EQ(reason_of(pulses_of("-999999999999999999mm", tiny)), Reason::out_of_range);
  EXPECT_EQ(reason_of(pulses_of("0.000000000000000001nm", huge)), Reason::not_representable);
  EXPECT_EQ(pulses_of("999999999999999999nm", huge), 1);
}

TEST(ToPulses, KeepsAnglesAndLengthsApart) {
  EXPECT_EQ(reason_of(pulses_of("5deg", k10Nanometers)), Reason::unknown_unit);
  EXPECT_EQ(reason_of(pulses_of("5mm", kMicrodegree)), Reason::unknown_unit);
  EXPECT_EQ(reason_of(pulses_of("5nm", kMicrodegree)), Reason::unknown_unit);
  EXPECT_EQ(pulses_of("5", kMicrodegree), 5);
}

TEST(ToPulses, RefusesAnUnusableScaleExceptForPulses) {
  EXPECT_EQ(reason_of(pulses_of("5mm", {{0, 0}, false})), Reason::device_error);
  EXPECT_EQ(reason_of(pulses_of("5mm", {{-10, 0}, false})), Reason::device_error);
  EXPECT_EQ(pulses_of("5", {{0, 0}, false}), 5);
}

TEST(FromPulses, IsExact) {
  EXPECT_EQ(text_of(500000, Unit::millimeters, k10Nanometers), "5");
  EXPECT_EQ(text_of(-20000, Unit::micrometers, k10Nanometers), "-200");
  EXPECT_EQ(text_of(1, Unit::millimeters, k10Nanometers), "0.00001");
  EXPECT_EQ(text_of(123, Unit::nanometers, k10Nanometers), "1230");
  EXPECT_EQ(text_of(-7, Unit::pulses, k10Nanometers), "-7");
  EXPECT_EQ(text_of(0, Unit::millimeters, k10Nanometers), "0");
  EXPECT_EQ(text_of(1000, Unit::degrees, kMicrodegree), "0.001");
  EXPECT_EQ(text_of(3, Unit::micrometers, {{125, 1}, false}), "0.0375");
}

TEST(FromPulses, RefusesWhatDoesNotFit) {
  EXPECT_EQ(text_of(std::numeric_limits<std::int64_t>::max(), Unit::nanometers, k10Nanometers), "OUT_OF_RANGE");
  EXPECT_EQ(text_of(std::numeric_limits<std::int64_t>::min(), Unit::nanometers, k10Nanometers), "OUT_OF_RANGE");
  EXPECT_EQ(text_of(1, Unit::millimeters, {{1, 18}, false}), "OUT_OF_RANGE");
  EXPECT_EQ(text_of(1, Unit::degrees, k10Nanometers), "UNKNOWN_UNIT");
  EXPECT_EQ(text_of(1, Unit::millimeters, kMicrodegree), "UNKNOWN_UNIT");
  EXPECT_EQ(text_of(1, Unit::millimeters, {{0, 0}, false}), "DEVICE_ERROR");
}

TEST(FromPulses, IsUndoneByToPulses) {
  for (const std::int64_t count : {-999'999'999LL, -123'456'789LL, -1LL, 0LL, 1LL, 42LL, 999'999'999LL}) {
    for (const Unit unit : {Unit::pulses, Unit::nanometers, Unit::micrometers, Unit::millimeters}) {
      const auto value = from_pulses(count, unit, {{125, 1}, false});
      ASSERT_TRUE(value) << count << symbol(unit);
      EXPECT_EQ(to_pulses({*value, unit}, {{125, 1}, false}), count) << symbol(unit);
    }
  }
}

Result<Scale> scale_named(std::string_view pulse) {
  return parse_quantity(pulse, Unit::pulses).and_then([](const Quantity& quantity) { return scale_of(quantity); });
}

TEST(ScaleOf, IsExact) {
  EXPECT_EQ(scale_named("1um"), (Scale{{1000, 0}, false}));
  EXPECT_EQ(scale_named("10nm"), k10Nanometers);
  EXPECT_EQ(scale_named("0.0000125mm"), (Scale{{125, 1}, false}));
  EXPECT_EQ(scale_named("0.5nm"), (Scale{{5, 1}, false}));
  EXPECT_EQ(scale_named("0.0025deg"), (Scale{{2500, 0}, true}));
  EXPECT_EQ(scale_named("0.00000125deg"), (Scale{{125, 2}, true}));
  EXPECT_EQ(pulse_text(*scale_named("1um")), "1000 nm");
  EXPECT_EQ(pulse_text(*scale_named("0.0025deg")), "0.0025 deg");
}

TEST(ScaleOf, IsAWayAboveZero) {
  EXPECT_EQ(reason_of(scale_named("1")), Reason::invalid_request);
  EXPECT_EQ(reason_of(scale_named("0um")), Reason::invalid_request);
  EXPECT_EQ(reason_of(scale_named("-1um")), Reason::invalid_request);
  EXPECT_EQ(reason_of(scale_named("999999999999999999mm")), Reason::out_of_range);
}

std::string in_turn(std::int64_t count, const Decimal& turn, const Scale& scale) {
  const auto place = within_turn(count, turn, scale);
  return place ? to_string(*place) : std::string(name(place.error().reason));
}

TEST(WithinTurn, IsExactOnBothSidesOfTheOrigin) {
  const Scale half_step = {{2500, 0}, true};
  const Decimal turn = {360, 0};
  EXPECT_EQ(in_turn(0, turn, half_step), "0");
  EXPECT_EQ(in_turn(143'999, turn, half_step), "359.9975");
  EXPECT_EQ(in_turn(144'000, turn, half_step), "0");
  EXPECT_EQ(in_turn(148'000, turn, half_step), "10");
  EXPECT_EQ(in_turn(-1, turn, half_step), "359.9975");
  EXPECT_EQ(in_turn(-144'000, turn, half_step), "0");
  EXPECT_EQ(in_turn(999'999'999, turn, half_step), "159.9975");
  EXPECT_EQ(in_turn(4, {225, 1}, {{7, 0}, true}), "0.000028");
  EXPECT_EQ(in_turn(9'001, {225, 1}, half_step), "0.0025");
}

// A turn is not a whole number of pulses here, and nothing is rounded, however many pulses there were.
TEST(WithinTurn, IsExactWhereATurnIsNoWholeNumberOfPulses) {
  EXPECT_EQ(in_turn(51'429, {360, 0}, {{7000, 0}, true}), "0.003");
  EXPECT_EQ(in_turn(999'999'999, {360, 0}, {{7000, 0}, true}), "159.993");
}

TEST(WithinTurn, IsOfAxesThatTurn) {
  EXPECT_EQ(in_turn(1, {360, 0}, k10Nanometers), "UNKNOWN_UNIT");
  EXPECT_EQ(in_turn(1, {360, 0}, {{0, 0}, true}), "DEVICE_ERROR");
  EXPECT_EQ(in_turn(1, {360, 0}, {{1, 18}, true}), "OUT_OF_RANGE");
}

}  // namespace
}  // namespace axisgate::quantity_test
