// Tests of device/shrc203/COMMANDS.md against the command table. With AXISGATE_WRITE_COMMANDS=1 in the environment, the
// test writes the file.
#include "tests/conformance/commands_page.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <sstream>

#include "device/shrc203/command/command_table.h"
#include "tests/paths/paths.h"

namespace axisgate::shrc203::conformance {
namespace {

constexpr int kSectionsOfTheManual = 136;
constexpr std::string_view kHowToWrite =
    "AXISGATE_WRITE_COMMANDS=1 build/bin/conformance_tests --gtest_filter='CommandsPage.*'";

std::string content(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// Returns the first line in which two texts differ, which is more useful than both pages.
std::string first_difference(const std::string& now, const std::string& wanted) {
  std::istringstream one(now), other(wanted);
  std::string stands, belongs;
  for (int number = 1;; ++number) {
    const bool more = !std::getline(one, stands).fail(), more_wanted = !std::getline(other, belongs).fail();
    if (more && more_wanted && stands == belongs) continue;
    return "line " + std::to_string(number) + "\n  in the file: " + (more ? stands : "(its end)") +
           "\n  by the table: " + (more_wanted ? belongs : "(its end)");
  }
}

TEST(CommandsPage, IsWhatTheTableSays) {
  const std::filesystem::path path = paths::in_project("device/shrc203/COMMANDS.md");
  const std::string wanted = commands_page();
  const char* write = std::getenv("AXISGATE_WRITE_COMMANDS");
  if (write != nullptr && std::string_view(write) == "1") {
    std::ofstream(path, std::ios::binary) << wanted;
    ASSERT_EQ(content(path), wanted) << path << " cannot be written";
    return;
  }
  const std::string now = content(path);
  EXPECT_TRUE(now == wanted) << "device/shrc203/COMMANDS.md is not what the table says, from "
                             << first_difference(now, wanted) << "\nwrite it anew: " << kHowToWrite;
}

TEST(CommandsPage, EverySectionOfTheManualIsThereOnce) {
  std::map<int, int> rows;
  for (const CommandRow& row : model().commands()) ++rows[row.section];
  for (int section = 1; section <= kSectionsOfTheManual; ++section) {
    EXPECT_EQ(rows[section], 1) << "rows of section " << section << ')';
  }
  EXPECT_EQ(rows.size(), static_cast<std::size_t>(kSectionsOfTheManual)) << "rows of sections that the manual has not";
}

TEST(CommandsPage, EveryLineHasAllCells) {
  std::istringstream page(commands_page());
  int lines = 0;
  for (std::string line; std::getline(page, line);) {
    if (!line.starts_with('|')) continue;
    ++lines;
    std::size_t bars = 0;
    for (std::size_t i = 0; i < line.size(); ++i) bars += line[i] == '|' && (i == 0 || line[i - 1] != '\\') ? 1 : 0;
    EXPECT_EQ(bars, 10u) << line;
  }
  EXPECT_EQ(lines, kSectionsOfTheManual + 2);
}

TEST(CommandsPage, TypedCallsAreOfRowsOfTheTable) {
  std::set<std::string_view> rows, named;
  for (const CommandRow& row : model().commands()) rows.insert(row.name);
  for (const TypedCall& call : typed_calls()) {
    EXPECT_TRUE(rows.contains(call.row)) << call.row << " is no row";
    EXPECT_TRUE(named.insert(call.row).second) << call.row << " stands there twice";
  }
}

// Reads the text of proto/, because this program also runs where gRPC is not installed.
TEST(CommandsPage, TypedCallsExist) {
  std::set<std::string> methods;
  for (const auto& entry : std::filesystem::directory_iterator(paths::in_project("proto/axisgate/v1"))) {
    std::istringstream file(content(entry.path()));
    std::string service;
    for (std::string line; std::getline(file, line);) {
      std::istringstream words(line);
      std::string word;
      words >> word;
      if (word == "service") words >> service;
      if (word != "rpc" || !(words >> word)) continue;
      methods.insert(service + '.' + word.substr(0, word.find('(')));
    }
  }
  for (const TypedCall& call : typed_calls()) {
    std::istringstream rpcs{std::string(call.rpcs)};
    for (std::string rpc; rpcs >> rpc;) {
      if (rpc.ends_with(',')) rpc.pop_back();
      EXPECT_TRUE(methods.contains(rpc)) << call.row << ": proto/ has no " << rpc;
    }
  }
}

}  // namespace
}  // namespace axisgate::shrc203::conformance
