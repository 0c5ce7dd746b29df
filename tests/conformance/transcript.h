// The transcripts' format (README.md beside this file), read strictly.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>
#include <vector>

namespace axisgate::shrc203::conformance {

struct Line {
  int number;  // in its file, from 1
  std::string text;
};

// The lines of one entry, comments left out.
using Block = std::vector<Line>;

struct Exchange {
  std::string line, reply;
};

struct Entry {
  std::string place;  // "moves.transcript:12", of its first line
  int section = 0;
  std::string row;
  std::string source;
  std::optional<std::string> offline;
  std::vector<std::pair<std::string, std::string>> device;
  std::vector<Exchange> setup;
  bool wait_until_ready = false;
  std::string sent;
  std::vector<std::pair<std::string, std::string>> meaning;
  std::string reply;
  std::vector<std::string> fields;
  std::vector<std::string> completions;
};

// OK, OK_D, NG, NG_I: no two of them are one byte apart.
bool is_answer_word(std::string_view reply);

std::vector<Block> split_blocks(std::string_view text);

// The entry, or what is wrong with it, beginning with file and line.
tl::expected<Entry, std::string> parse_entry(std::string_view file, const Block& block);

struct Transcripts {
  struct Example {
    std::string file;
    Block block;
    Entry entry;
  };
  std::vector<Example> examples;
  std::vector<std::string> mistakes;  // files and entries that cannot be read
};

// Every *.transcript of the project, in the order of the files' names. Read once.
const Transcripts& all_transcripts();

}  // namespace axisgate::shrc203::conformance
