// Damaged files of the journal: damage that the start finds, that verify() finds, and that only a head noted elsewhere
// shows.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include <array>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <ostream>
#include <sstream>
#include <string>
#include <vector>

#include "server/journal/journal.h"
#include "tests/simulation/random.h"
#include "tests/unit/journal/journal_rows.h"
#include "tests/unit/journal/losing_disk.h"
#include "tests/unit/journal/losing_vfs.h"
#include "tests/unit/link/link_fixtures.h"

namespace axisgate::server::journal::damage_test {
namespace {

using disk_test::LosingDisk;
using disk_test::LosingVfs;
using testing::HasSubstr;

const std::string kFile = "/journal.sqlite", kLog = "/journal.sqlite-wal";
// Sizes in bytes from https://www.sqlite.org/fileformat2.html, sections 1.2 and 4.1.
constexpr std::size_t kPage = 4096, kLogHeader = 32, kFrameHeader = 24, kFrame = kFrameHeader + kPage;

// The bytes of a journal's files, and the rows that were acknowledged.
struct Image {
  struct Group {
    std::size_t log_size = 0;  // in bytes, when the group was acknowledged
    std::size_t rows = 0;      // including all earlier rows
  };

  std::string file, log;
  std::vector<Entry> rows;
  std::vector<Group> groups;  // the rows in the main file first, then each group in the log
  Head head;
};

void append(Store& store, std::size_t rows, Image& image) {
  std::vector<Entry> group;
  for (std::size_t i = 1; i <= rows; ++i) group.push_back(journal_rows::entry(image.rows.size() + i));
  EXPECT_TRUE(store.append(journal_rows::records_of(group)));
  image.rows.insert(image.rows.end(), group.begin(), group.end());
}

// Returns the files as a machine without power has them: rows that a checkpoint has written into the main file, and
// groups in the log.
Image image_of(std::size_t rows_in_file, const std::vector<std::size_t>& groups_in_log) {
  LosingDisk disk;
  const LosingVfs vfs(disk);
  Image image;
  if (rows_in_file > 0) {
    Store closed_soon = *Store::open(kFile, vfs.name());
    append(closed_soon, rows_in_file, image);
  }
  image.groups.push_back({0, rows_in_file});
  Store store = *Store::open(kFile, vfs.name());
  for (const std::size_t rows : groups_in_log) {
    append(store, rows, image);
    image.groups.push_back({disk.find(kLog)->bytes().size(), image.rows.size()});
  }
  image.head = *store.head();
  image.file = disk.find(kFile)->bytes();
  image.log = disk.find(kLog)->bytes();
  return image;
}

enum class Outcome {
  damaged,     // the start finds the damage and moves the file aside
  refused,     // the start finds the damage and leaves the file in place
  unreadable,  // verify() fails
  bad_row,     // verify() names a bad row
  bad_index,   // verify() finds all rows good, but other damage
  complete,    // all acknowledged rows are present
  unnoticed,   // rows are missing or changed, and verify() reports nothing
};
void PrintTo(Outcome outcome, std::ostream* out) {
  constexpr std::array kNames{"damaged", "refused", "unreadable", "bad_row", "bad_index", "complete", "unnoticed"};
  *out << kNames.at(static_cast<std::size_t>(outcome));
}

struct Finding {
  Outcome alone = Outcome::unnoticed, with_head = Outcome::unnoticed;
  std::size_t rows = 0;  // acknowledged rows that are present, in their order
};

Outcome verified(Store& store, const std::optional<Head>& noted, bool complete) {
  const auto verdict = store.verify(noted);
  if (!verdict) {
    EXPECT_THAT(verdict.error().message, HasSubstr(kFile));
    return Outcome::unreadable;
  }
  if (verdict->first_bad) return Outcome::bad_row;
  if (!verdict->fault.empty()) return complete ? Outcome::bad_index : Outcome::unnoticed;
  return complete ? Outcome::complete : Outcome::unnoticed;
}

Finding find(const Image& image) {
  LosingDisk disk;
  const LosingVfs vfs(disk);
  disk.create(kFile)->write(0, image.file);
  disk.create(kLog)->write(0, image.log);
  auto store = Store::open(kFile, vfs.name());
  if (!store) {
    EXPECT_THAT(store.error().problem.message, HasSubstr(kFile));
    const Outcome outcome = store.error().damaged ? Outcome::damaged : Outcome::refused;
    return {outcome, outcome};
  }
  const auto rows = store->read({}, image.rows.size() + 1);
  const bool good = rows && journal_rows::begin_as(image.rows, *rows, journal_rows::same_but_for_names);
  const bool complete = good && rows->size() == image.rows.size();
  return {verified(*store, std::nullopt, complete), verified(*store, image.head, complete), good ? rows->size() : 0};
}

void change_byte(std::string& bytes, std::size_t at, unsigned bits) {
  bytes[at] = static_cast<char>(static_cast<unsigned char>(bytes[at]) ^ bits);
}

// Returns the offsets to damage: the header of each frame, the byte before the header, and every 499th byte. Each takes
// 0.4 ms; testing all bytes, with AXISGATE_EVERY_BYTE=1, takes some minutes.
std::vector<std::size_t> places_in(const std::string& log) {
  const bool all = std::getenv("AXISGATE_EVERY_BYTE") != nullptr;
  std::vector<std::size_t> places;
  for (std::size_t at = 0; at < log.size(); ++at) {
    const std::size_t in_frame = (at + kFrame - kLogHeader) % kFrame;
    if (all || in_frame <= kFrameHeader || in_frame == kFrame - 1 || at < kLogHeader || at % 499 == 0) {
      places.push_back(at);
    }
  }
  return places;
}

// Checks that the groups acknowledged before `place` are present, and that only a head shows that the rest is missing.
void expect_groups_before(std::size_t place, const Image& whole, const Image& damaged) {
  std::size_t rows = 0;
  for (const Image::Group& group : whole.groups) rows = group.log_size <= place ? group.rows : rows;
  const Finding finding = find(damaged);
  EXPECT_EQ(finding.alone, Outcome::unnoticed);
  EXPECT_EQ(finding.rows, rows);
  EXPECT_EQ(finding.with_head, Outcome::bad_row);
}

TEST(JournalDamage, ALogThatIsCutOrChangedAnywhereKeepsTheGroupsBefore) {
  for (const std::size_t rows_in_file : {0u, 40u}) {
    const Image whole = image_of(rows_in_file, {1, 4, 1});
    for (const std::size_t place : places_in(whole.log)) {
      SCOPED_TRACE(fmt::format("byte {} of the log, {} rows in the file", place, rows_in_file));
      Image cut = whole, changed = whole;
      cut.log.resize(place);
      expect_groups_before(place, whole, cut);
      change_byte(changed.log, place, 0x10);
      expect_groups_before(place, whole, changed);
    }
  }
}

// A journal file with and without a log, which has newer versions of some pages.
class JournalFileDamage : public testing::TestWithParam<std::size_t> {
 protected:
  const Image whole_ = GetParam() == 0 ? image_of(40, {}) : image_of(40, {GetParam()});
};
INSTANTIATE_TEST_SUITE_P(RowsInTheLog, JournalFileDamage, testing::Values(0, 4));

// The outcome is complete if the log has the page.
TEST_P(JournalFileDamage, AnOverwrittenPageLosesNoRowUnnoticed) {
  int bad_index = 0;
  for (std::size_t page = 0; page < whole_.file.size() / kPage; ++page) {
    simulation::Random random(page);
    std::string noise;
    for (std::size_t i = 0; i < kPage; ++i) noise += static_cast<char>(random.next());
    for (const std::string& content : {std::string(kPage, '\0'), std::string(kPage, '\xFF'), noise}) {
      SCOPED_TRACE(fmt::format("page {}, now {:#04x} and so on", page + 1, static_cast<unsigned char>(content[0])));
      Image damaged = whole_;
      damaged.file.replace(page * kPage, kPage, content);
      const Outcome outcome = find(damaged).with_head;
      EXPECT_NE(outcome, Outcome::unnoticed);
      if (whole_.log.empty()) {
        EXPECT_EQ(outcome == Outcome::damaged, page == 0);
        EXPECT_NE(outcome, Outcome::complete);
      }
      bad_index += outcome == Outcome::bad_index ? 1 : 0;
    }
  }
  if (whole_.log.empty()) {
    EXPECT_GE(bad_index, 3 * 3) << "the pages of the three indices";
  }
}

// Changes the header of each page and every 97th byte.
TEST_P(JournalFileDamage, AChangedByteLosesNoRowUnnoticed) {
  for (std::size_t at = 0; at < whole_.file.size(); ++at) {
    if (at % kPage >= 12 && at % 97 != 0) continue;
    for (const unsigned bits : {0x01u, 0xFFu}) {
      SCOPED_TRACE(fmt::format("byte {} of the file, bits {:#x}", at, bits));
      Image damaged = whole_;
      change_byte(damaged.file, at, bits);
      EXPECT_NE(find(damaged).with_head, Outcome::unnoticed);
    }
  }
}

TEST_P(JournalFileDamage, AShorterFileLosesNoRowUnnoticed) {
  for (std::size_t size = 0; size < whole_.file.size(); size += 512) {
    SCOPED_TRACE(fmt::format("{} bytes", size));
    Image damaged = whole_;
    damaged.file.resize(size);
    EXPECT_NE(find(damaged).with_head, Outcome::unnoticed);
  }
}

// The start begins a new journal. A missing file is the same case: the start creates an empty file before SQLite opens
// it.
TEST_P(JournalFileDamage, AnEmptyFileIsNoticedByAHeadAlone) {
  Image damaged = whole_;
  damaged.file.clear();
  const Finding finding = find(damaged);
  EXPECT_EQ(finding.alone, Outcome::unnoticed);
  EXPECT_EQ(finding.rows, 0u);
  EXPECT_EQ(finding.with_head, Outcome::bad_row);
}

// https://www.sqlite.org/fileformat2.html, section 1.6: a leaf of a table begins with 0x0D, and byte 4 has its number
// of rows. The table of facts has no rows here.
TEST(JournalDamage, ALeafThatHasLostItsLastRowIsNoticedByAHeadAlone) {
  const Image whole = image_of(40, {});
  std::size_t leaf = whole.file.size() - kPage;
  while (whole.file[leaf] != 0x0D || whole.file[leaf + 4] == 0) leaf -= kPage;
  Image damaged = whole;
  --damaged.file[leaf + 4];
  const Finding finding = find(damaged);
  EXPECT_EQ(finding.alone, Outcome::unnoticed);
  EXPECT_EQ(finding.rows, 39u);
  EXPECT_EQ(finding.with_head, Outcome::bad_row);
}

// Returns the file that was moved aside and whose name begins with `path`; empty if there is none.
std::string moved_aside(const std::string& path) {
  for (const auto& file : std::filesystem::directory_iterator(std::filesystem::path(path).parent_path())) {
    if (file.path().string().starts_with(path + ".damaged-")) return file.path();
  }
  return {};
}

std::string content(const std::string& path) {
  std::ostringstream bytes;
  bytes << std::ifstream(path, std::ios::binary).rdbuf();
  return bytes.str();
}

TEST(JournalDamage, ADamagedFileIsMovedAsideWholeAndTheLogNamesBoth) {
  const link_test::TemporaryDirectory directory;
  const std::string path = directory / "journal.sqlite";
  std::string damaged = image_of(40, {}).file;
  damaged.replace(0, kPage, kPage, 'x');
  std::ofstream(path) << damaged;
  std::ostringstream log;
  const auto before = spdlog::default_logger();
  spdlog::set_default_logger(
      std::make_shared<spdlog::logger>("test", std::make_shared<spdlog::sinks::ostream_sink_mt>(log)));
  const auto journal = Journal::open(path);
  spdlog::set_default_logger(before);
  ASSERT_TRUE(journal) << journal.error().message;
  EXPECT_EQ((*journal)->head()->number, 0);
  const std::string kept = moved_aside(path);
  EXPECT_EQ(content(kept), damaged);
  EXPECT_THAT(log.str(), HasSubstr(fmt::format("journal {}: it is damaged, and was moved to {};", path, kept)));
}

}  // namespace
}  // namespace axisgate::server::journal::damage_test
