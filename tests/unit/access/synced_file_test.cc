// Files of the state directory: no link is followed, only regular files are read, and no call waits.
#include "server/access/synced_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "server/access/generation.h"
#include "server/access/tokens.h"
#include "server/devices/saved_positions.h"
#include "tests/unit/journal/file_size_limit.h"

namespace axisgate::server::synced_file_test {
namespace {

namespace fs = std::filesystem;

class StateFile : public testing::Test {
 protected:
  StateFile() : folder_(testing::TempDir() + "axisgate-state-file-" + std::to_string(::getpid())) {
    fs::remove_all(folder_);
    fs::create_directory(folder_);
  }
  ~StateFile() override { fs::remove_all(folder_); }

  std::string path(const std::string& name = "tokens") const { return folder_ + "/" + name; }
  void write(const std::string& name, const std::string& text) const { std::ofstream(path(name)) << text; }
  std::string content(const std::string& name) const {
    std::ostringstream text;
    text << std::ifstream(path(name)).rdbuf();
    return text.str();
  }
  static std::string why(const std::string& path) {
    const auto read = read_state_file(path);
    return read ? "read" : read.error().message + "; " + read.error().hint;
  }

  const std::string folder_;
};

TEST_F(StateFile, WhatWasWrittenIsRead) {
  const std::string text(10'000, 'x');
  ASSERT_TRUE(replace_synced(path(), text));
  EXPECT_EQ(read_state_file(path()).value(), text);
  EXPECT_EQ(read_state_file(path("missing")).value(), "");
  EXPECT_EQ(read_state_file("").value(), "") << "a daemon of the tests keeps nothing";
}

TEST_F(StateFile, OnlyARegularFileIsRead) {
  const std::string otherwise = ", not a regular file; move it away: the daemon makes this file itself";
  ASSERT_EQ(::mkfifo(path().c_str(), 0600), 0);
  EXPECT_EQ(why(path()), path() + " is a FIFO" + otherwise);
  write("elsewhere", "1");
  fs::create_symlink(path("elsewhere"), path("link"));
  EXPECT_EQ(why(path("link")), path("link") + " is a symbolic link" + otherwise);
  fs::create_directory(path("directory"));
  EXPECT_EQ(why(path("directory")), path("directory") + " is a directory" + otherwise);
  EXPECT_EQ(why("/dev/null"), "/dev/null is a device or a socket" + otherwise);
}

TEST_F(StateFile, ALinkToNothingIsNotTakenForAMissingFile) {
  fs::create_symlink(path("nowhere"), path());
  EXPECT_NE(why(path()), "read");
  EXPECT_FALSE(open_state_file(path(), O_RDONLY | O_CREAT));
  EXPECT_FALSE(fs::exists(path("nowhere")));
}

TEST_F(StateFile, WhatOthersMayWriteIsRefused) {
  write("tokens", "1");
  ASSERT_EQ(::chmod(path().c_str(), 0606), 0);
  EXPECT_EQ(why(path()),
            path() +
                " may be written by everybody on this machine, who could change what the daemon does; chmod go-w " +
                path());
}

TEST_F(StateFile, EveryReaderOfTheDirectoryRefusesTheSame) {
  for (const char* name : {"generation", "tokens", "positions"}) ASSERT_EQ(::mkfifo(path(name).c_str(), 0600), 0);
  const auto generation = next_generation(folder_, 1);
  ASSERT_FALSE(generation);
  EXPECT_EQ(generation.error().message, path("generation") + " is a FIFO, not a regular file");
  const auto tokens = Tokens::open(path("tokens"));
  ASSERT_FALSE(tokens);
  EXPECT_EQ(tokens.error().message, path("tokens") + " is a FIFO, not a regular file");
  const auto positions = SavedPositions::open(path("positions"));
  ASSERT_FALSE(positions);
  EXPECT_EQ(positions.error().message, path("positions") + " is a FIFO, not a regular file");
}

TEST_F(StateFile, NothingIsWrittenThroughALink) {
  write("victim", "kept");
  fs::create_symlink(path("victim"), path("tokens.new"));
  fs::create_symlink(path("victim"), path("tokens"));
  ASSERT_TRUE(replace_synced(path(), "fresh"));
  EXPECT_EQ(content("victim"), "kept");
  EXPECT_FALSE(fs::is_symlink(path()));
  EXPECT_EQ(content("tokens"), "fresh");
}

TEST_F(StateFile, WhatAKilledDaemonLeftIsReplaced) {
  write("tokens.new", "half of something lo");
  ASSERT_EQ(::chmod(path("tokens.new").c_str(), 0666), 0);
  ASSERT_TRUE(replace_synced(path(), "fresh"));
  EXPECT_EQ(content("tokens"), "fresh");
  EXPECT_EQ(fs::status(path()).permissions(), fs::perms::owner_read | fs::perms::owner_write);
  // Otherwise a reader of the FIFO would receive the file.
  ASSERT_EQ(::mkfifo(path("tokens.new").c_str(), 0600), 0);
  ASSERT_TRUE(replace_synced(path(), "newer"));
  EXPECT_EQ(content("tokens"), "newer");
}

TEST_F(StateFile, AFullDiskLeavesWhatWasThereAndSaysWhy) {
  ASSERT_TRUE(replace_synced(path(), "kept"));
  const auto replaced = [this] {
    const FileSizeLimit limit(10);
    return replace_synced(path(), "more than ten bytes");
  }();
  ASSERT_FALSE(replaced);
  EXPECT_EQ(replaced.error().message, "cannot write " + path("tokens.new") + ": File too large");
  EXPECT_EQ(content("tokens"), "kept");
}

TEST_F(StateFile, AFullDiskIsToBeFreed) {
  const int full = ::open("/dev/full", O_WRONLY | O_CLOEXEC);
  ASSERT_FALSE(write_all(full, "x"));
  const Problem problem = cannot_write("/dev/full").value();
  ::close(full);
  EXPECT_EQ(problem.message, "cannot write /dev/full: No space left on device");
  EXPECT_EQ(problem.hint, "free space on its disk");
}

TEST_F(StateFile, TheDirectoryIsMadeForThisUserAlone) {
  const mode_t before = ::umask(0);
  EXPECT_TRUE(replace_synced(folder_ + "/deeper/state/tokens", "1"));
  make_state_directory(folder_ + "/slash/");
  ::umask(before);
  EXPECT_EQ(fs::status(folder_ + "/deeper/state").permissions(), fs::perms::owner_all);
  EXPECT_EQ(fs::status(folder_ + "/slash").permissions(), fs::perms::owner_all);
}

}  // namespace
}  // namespace axisgate::server::synced_file_test
