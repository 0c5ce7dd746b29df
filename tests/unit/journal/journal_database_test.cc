// Prepared statements, which are kept after each run. No binding or result of one run remains for the next.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "server/journal/database.h"
#include "tests/unit/link/link_fixtures.h"

namespace axisgate::server::journal {
namespace {

class DatabaseTest : public testing::Test {
 protected:
  DatabaseTest() { EXPECT_TRUE(database_.run("CREATE TABLE t(a TEXT); INSERT INTO t VALUES('x'), ('y');")); }

  const link_test::TemporaryDirectory directory_;
  const std::string path_ = directory_ / "a.sqlite";
  Database database_ = *Database::open(path_, Database::Access::write);
};

TEST_F(DatabaseTest, WhatWasBoundIsNotBoundInTheNextRun) {
  constexpr const char* kSql = "SELECT ?1 IS NULL";
  EXPECT_TRUE(database_.prepare(kSql)->bind(1, "bert").step());
  auto again = database_.prepare(kSql);
  EXPECT_TRUE(*again->step());
  EXPECT_EQ(again->integer(0), 1);
}

TEST_F(DatabaseTest, ARunThatWasNotReadToItsEndBeginsAgain) {
  constexpr const char* kSql = "SELECT a FROM t ORDER BY a";
  EXPECT_TRUE(*database_.prepare(kSql)->step());
  auto again = database_.prepare(kSql);
  EXPECT_TRUE(*again->step());
  EXPECT_EQ(again->bytes(0), "x");
}

TEST_F(DatabaseTest, ARunThatWasNotReadToItsEndDoesNotHoldTheLog) {
  EXPECT_TRUE(*database_.prepare("SELECT a FROM t")->step());
  EXPECT_TRUE(Database::open(path_, Database::Access::write)->empty_log());
}

TEST_F(DatabaseTest, TwoOfOneTextAtOnceAreApart) {
  constexpr const char* kSql = "SELECT a FROM t ORDER BY a";
  auto one = database_.prepare(kSql), other = database_.prepare(kSql);
  EXPECT_TRUE(*one->step() && *one->step() && *other->step());
  EXPECT_EQ(one->bytes(0), "y");
  EXPECT_EQ(other->bytes(0), "x");
}

TEST_F(DatabaseTest, AKeptStatementSeesATableThatWasMadeAgain) {
  constexpr const char* kSql = "SELECT a FROM t";
  EXPECT_TRUE(*database_.prepare(kSql)->step());
  EXPECT_TRUE(
      database_.run("ALTER TABLE t RENAME TO was; CREATE TABLE t(b INTEGER, a TEXT); "
                    "INSERT INTO t VALUES(1, 'z'); DROP TABLE was;"));
  auto again = database_.prepare(kSql);
  EXPECT_TRUE(*again->step());
  EXPECT_EQ(again->bytes(0), "z");
}

TEST_F(DatabaseTest, ManyTextsAreServed) {
  for (int i = 0; i < 3 * static_cast<int>(KeptStatements::kMost); ++i) {
    auto row = database_.prepare("SELECT " + std::to_string(i));
    EXPECT_TRUE(*row->step());
    EXPECT_EQ(row->integer(0), i);
  }
}

}  // namespace
}  // namespace axisgate::server::journal
