// The disk of the power cut tests, which loses only data that a real disk may lose.
#include "tests/unit/journal/losing_disk.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <string>

namespace axisgate::disk_test {
namespace {

const std::string kOld(2 * kSector, 'o'), kNew(2 * kSector, 'n'), kNewer(2 * kSector, 'r');
const std::string kNone = "no file";

// Returns every content that a file may have after a cut, over many seeds.
template <class Program>
std::set<std::string> survivors(Program program) {
  std::set<std::string> found;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    LosingDisk disk;
    program(disk);
    disk.cut_power(seed);
    const auto file = disk.find("file");
    found.insert(file ? file->bytes() : kNone);
  }
  return found;
}

void create_synced(LosingDisk& disk) {
  disk.create("file")->write(0, kOld);
  disk.sync(*disk.find("file"));
  disk.sync_directory();
}

TEST(LosingDisk, KeepsWhatWasSynced) { EXPECT_THAT(survivors(create_synced), testing::ElementsAre(kOld)); }

TEST(LosingDisk, KeepsAnySectorsOfAWriteThatWasNotSynced) {
  const auto found = survivors([](LosingDisk& disk) {
    create_synced(disk);
    disk.find("file")->write(0, kNew);
  });
  const std::string torn = kOld.substr(kSector) + kNew.substr(kSector);
  EXPECT_THAT(found, testing::UnorderedElementsAre(kOld, kNew, torn, std::string(torn.rbegin(), torn.rend())));
}

TEST(LosingDisk, KeepsWritesThatWereNotSyncedInAnyOrder) {
  const auto found = survivors([](LosingDisk& disk) {
    create_synced(disk);
    disk.find("file")->write(0, kNew);
    disk.find("file")->write(0, kNewer);
  });
  EXPECT_EQ(found.size(), 3u * 3u) << "each sector is of one of three";
}

TEST(LosingDisk, MayLoseATruncationThatWasNotSynced) {
  const auto found = survivors([](LosingDisk& disk) {
    create_synced(disk);
    disk.find("file")->truncate(3);
  });
  EXPECT_THAT(found, testing::UnorderedElementsAre(kOld, "ooo"));
}

TEST(LosingDisk, MayLoseANameThatWasNotSynced) {
  const auto found = survivors([](LosingDisk& disk) {
    disk.create("file")->write(0, kOld);
    disk.sync(*disk.find("file"));
  });
  EXPECT_THAT(found, testing::UnorderedElementsAre(kOld, kNone));
}

TEST(LosingDisk, MayRestoreAFileWhoseRemovalWasNotSynced) {
  const auto found = survivors([](LosingDisk& disk) {
    create_synced(disk);
    disk.remove("file");
  });
  EXPECT_THAT(found, testing::UnorderedElementsAre(kOld, kNone));
}

}  // namespace
}  // namespace axisgate::disk_test
