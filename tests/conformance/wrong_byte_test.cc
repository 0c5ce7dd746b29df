// Tests that the checks depend on every byte of a transcript: with any wrong byte, the entry fails.
#include <gtest/gtest.h>

#include <cctype>
#include <iostream>

#include "tests/conformance/verification.h"

namespace axisgate::shrc203::conformance {
namespace {

// Returns likely typing mistakes for a byte: its successor, the other case, the other sign, a missing or an extra
// blank.
std::string likely_mistakes_for(char right) {
  const auto byte = static_cast<unsigned char>(right);
  if (std::isdigit(byte)) return {right == '9' ? '0' : static_cast<char>(right + 1), 'O'};
  if (std::islower(byte)) return {right == 'z' ? 'a' : static_cast<char>(right + 1), static_cast<char>(right - 32)};
  if (std::isupper(byte)) return {right == 'Z' ? 'A' : static_cast<char>(right + 1), static_cast<char>(right + 32)};
  if (right == '+') return "-0";
  if (right == '-') return "+ ";
  if (right == ' ') return "0_";
  return right == ',' ? ".;" : ", ";
}

std::string all_but(char right) {
  std::string bytes;
  for (char byte = ' '; byte <= '~'; ++byte) {
    if (byte != right) bytes += byte;
  }
  return bytes;
}

bool is_on_the_wire(std::string_view line) {
  return line.starts_with("> ") || line.starts_with("< ") || line.starts_with("after: ");
}

// Returns the first byte of a line whose change must be detected. Sources and reasons are texts for people. The same
// state can often be reached by different setups, so only the reply of a setup counts.
std::size_t first_bound_byte(std::string_view line) {
  if (line.starts_with("source: ") || line.starts_with("offline: ") || line.starts_with("device: ")) return line.size();
  if (line.starts_with("setup: ")) return line.rfind(" -> ") + 4;
  return 0;
}

bool is_refused(const Transcripts::Example& example, const Block& wrong) {
  const auto entry = parse_entry(example.file, wrong);
  return !entry || check(*entry);
}

int try_wrong_bytes(const Transcripts::Example& example) {
  int count = 0;
  Block block = example.block;
  for (Line& line : block) {
    const auto wrong_bytes_for = is_on_the_wire(line.text) ? all_but : likely_mistakes_for;
    for (std::size_t i = first_bound_byte(line.text); i < line.text.size(); ++i) {
      const char right = line.text[i];
      for (const char wrong : wrong_bytes_for(right)) {
        line.text[i] = wrong;
        ++count;
        EXPECT_TRUE(is_refused(example, block)) << example.file << ":" << line.number << ": passes as " << line.text;
      }
      line.text[i] = right;
    }
  }
  return count;
}

TEST(Transcripts, OneWrongByteFails) {
  int count = 0;
  for (const auto& example : all_transcripts().examples) count += try_wrong_bytes(example);
  std::cout << count << " wrong bytes tried in " << all_transcripts().examples.size() << " transcripts\n";
  EXPECT_GT(count, 0);
}

// The simulator does not check the reply of an offline entry, but wrong bytes must still be detected.
TEST(Transcripts, OneMissingOrDoubledByteFails) {
  for (const auto& example : all_transcripts().examples) {
    for (std::size_t i = 0; i < example.entry.reply.size(); ++i) {
      Entry shorter = example.entry, longer = example.entry;
      shorter.reply.erase(i, 1);
      longer.reply.insert(i, 1, longer.reply[i]);
      EXPECT_TRUE(check(shorter)) << example.entry.place << ": passes with the reply " << shorter.reply;
      EXPECT_TRUE(check(longer)) << example.entry.place << ": passes with the reply " << longer.reply;
    }
  }
}

}  // namespace
}  // namespace axisgate::shrc203::conformance
