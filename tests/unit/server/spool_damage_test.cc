// Jobs on a disk that is damaged, full, or writable by other users.
#include <gmock/gmock.h>
#include <sys/stat.h>

#include <functional>
#include <nlohmann/json.hpp>

#include "tests/api/log.h"
#include "tests/unit/journal/file_size_limit.h"
#include "tests/unit/server/spool_bed.h"

namespace axisgate::server::spool_damage_test {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

class SpoolDamage : public spool_test::SpoolBed {
 protected:
  // Uploads job 1, which stays good, and job 2, which `change` damages; then restarts the daemon twice.
  void damage(const std::function<void()>& change) {
    ASSERT_TRUE(upload("good"));
    ASSERT_TRUE(upload("abc"));
    change();
    std::string log = reopened();
    EXPECT_THAT(log, HasSubstr("job 2 is not used, and its files are renamed to *.damaged-"));
    first_log_ = log;
    EXPECT_THAT(ids(), ElementsAre(1));
    EXPECT_FALSE(fs::exists(fs::symlink_status(path("2.json"))));
    EXPECT_FALSE(fs::exists(fs::symlink_status(path("2.rml"))));
    EXPECT_EQ(spool_->read("mill", 1).value(), "good");
    const auto left = files();
    EXPECT_EQ(reopened(), "");
    EXPECT_EQ(files(), left);
    EXPECT_EQ(upload("next")->id, 3u);
  }
  // Opens the spool again, and returns the log lines of this start.
  std::string reopened() {
    const api::Log log;
    open();
    return log.text();
  }
  void edit(const std::function<void(nlohmann::json&)>& change) const {
    auto record = nlohmann::json::parse(content("2.json"));
    change(record);
    write("2.json", record.dump());
  }
  std::string aside(const std::string& name) const {
    for (const std::string& file : files()) {
      if (file.starts_with(name + ".damaged-")) return content(file);
    }
    return "missing";
  }

  std::string first_log_;
};

TEST_F(SpoolDamage, OfABit) {
  damage([this] { write("2.rml", "abb"); });
  EXPECT_THAT(first_log_, StartsWith(path("2.rml") + " does not have the bytes that were uploaded; "));
  EXPECT_EQ(aside("2.rml"), "abb");
  EXPECT_THAT(aside("2.json"), HasSubstr("part.rml"));
}

TEST_F(SpoolDamage, OfBytesThatAreMissing) {
  damage([this] { write("2.rml", "ab"); });
}

TEST_F(SpoolDamage, OfAllBytes) {
  damage([this] { fs::remove(path("2.rml")); });
  EXPECT_THAT(aside("2.json"), HasSubstr("part.rml"));
  EXPECT_EQ(aside("2.rml"), "missing");
}

TEST_F(SpoolDamage, OfARecord) {
  damage([this] { write("2.json", content("2.json").substr(0, 50)); });
  EXPECT_THAT(first_log_, StartsWith(path("2.json") + " does not describe a job 2; "));
  EXPECT_EQ(aside("2.rml"), "abc");
}

TEST_F(SpoolDamage, OfARecordThatIsOfAnotherJob) {
  damage([this] { write("2.json", content("1.json")); });
}

TEST_F(SpoolDamage, OfARecordThatIsALink) {
  damage([this] {
    write("elsewhere", content("2.json"));
    fs::remove(path("2.json"));
    fs::create_symlink(path("elsewhere"), path("2.json"));
  });
}

TEST_F(SpoolDamage, OfBytesThatAreAFifo) {
  damage([this] {
    fs::remove(path("2.rml"));
    ASSERT_EQ(::mkfifo(path("2.rml").c_str(), 0600), 0);
  });
}

TEST_F(SpoolDamage, OfARecordThatEverybodyMayWrite) {
  damage([this] { ASSERT_EQ(::chmod(path("2.json").c_str(), 0606), 0); });
  EXPECT_THAT(first_log_, HasSubstr("may be written by everybody on this machine"));
}

TEST_F(SpoolDamage, OfBytesThatEverybodyMayWrite) {
  damage([this] { ASSERT_EQ(::chmod(path("2.rml").c_str(), 0606), 0); });
}

struct Edit {
  const char* name;
  const char* key;
  nlohmann::json value;
};
void PrintTo(const Edit& edit, std::ostream* out) { *out << edit.name; }

class SpoolDamageOfAField : public SpoolDamage, public testing::WithParamInterface<Edit> {};

TEST_P(SpoolDamageOfAField, IsFound) {
  damage([this] { edit([](nlohmann::json& record) { record[GetParam().key] = GetParam().value; }); });
}

INSTANTIATE_TEST_SUITE_P(Each, SpoolDamageOfAField,
                         testing::Values(Edit{"ANegativeNumber", "id", -2}, Edit{"AFraction", "bytes", 3.5},
                                         Edit{"ANameThatClearsTheScreen", "name", "\x1B[2J"},
                                         Edit{"APath", "name", "../part.rml"}, Edit{"NoText", "facts", 7},
                                         Edit{"NoTime", "created", "yesterday"}, Edit{"NoEnd", "ended", -1},
                                         Edit{"AnotherHash", "sha256", "00"},
                                         Edit{"ASizeBeyondAll", "bytes", 18'446'744'073'709'551'615U}),
                         [](const auto& edit) { return std::string(edit.param.name); });

TEST_F(SpoolDamage, ATimeBeyondTheCalendarIsCut) {
  ASSERT_TRUE(upload("good"));
  ASSERT_TRUE(upload("abc"));
  edit([](nlohmann::json& record) { record["ended"] = 18'446'744'073'709'551'615U; });
  open();
  ASSERT_TRUE(spool_->drop_old(spool_test::kNow));
  EXPECT_THAT(ids(), ElementsAre(1, 2)) << "it ends in the year 9999";
}

TEST_F(SpoolDamage, AnUploadOfAKilledDaemonIsRemoved) {
  ASSERT_TRUE(upload("good"));
  write("7.rml", "abc");
  write("7.json.new", "{");
  write("upload-3", "ab");
  const std::string log = reopened();
  EXPECT_THAT(log, HasSubstr(path("7.rml") + ": its upload was not finished; it is removed"));
  EXPECT_THAT(log, HasSubstr(path("upload-3") + ": its upload was not finished; it is removed"));
  EXPECT_THAT(files(), ElementsAre("1.json", "1.rml", "last"));
  EXPECT_EQ(upload("next")->id, 8u);
}

TEST_F(SpoolDamage, OtherFilesAreLeftAlone) {
  for (const char* name : {"007.json", "007.rml", "7.rml.bak", "notes", "x.rml", ".rml"}) write(name, "kept");
  std::ofstream(folder_ + "/notes.txt") << "kept";
  EXPECT_EQ(reopened(), "");
  EXPECT_THAT(files(), ElementsAre(".rml", "007.json", "007.rml", "7.rml.bak", "notes", "x.rml"));
}

TEST_F(SpoolDamage, ALastNumberThatIsNoneIsReplaced) {
  ASSERT_TRUE(upload("a"));
  ASSERT_TRUE(upload("b"));
  write("last", "x\n");
  EXPECT_THAT(reopened(), StartsWith(path("last") + " has no number; the next job has the number after the highest"));
  EXPECT_EQ(upload("c")->id, 3u);
  EXPECT_EQ(content("last"), "3\n");
  EXPECT_EQ(reopened(), "");
}

TEST_F(SpoolDamage, WhileTheDaemonRuns) {
  ASSERT_TRUE(upload("abc"));
  write("1.rml", "abb");
  EXPECT_EQ(why(spool_->read("mill", 1)), "INTERNAL: " + path("1.rml") + " does not have the bytes that were uploaded");
  EXPECT_THAT(ids(), ElementsAre(1));
}

TEST_F(SpoolDamage, ADirectoryThatCannotBeMadeRefusesUploadsOnly) {
  std::ofstream(directory_ / "file") << "x";
  for (const auto& [folder, error] : {std::pair(directory_ / "file" + "/spool", "Not a directory"),
                                      std::pair(std::string("/proc/axisgate/spool"), "No such file or directory")}) {
    auto opened = spool::Spool::open(folder, {});
    ASSERT_TRUE(opened) << opened.error().message;
    EXPECT_EQ(why((*opened)->begin("mill", new_job())),
              "INTERNAL: cannot write " + folder + "/mill/upload-1: " + error);
  }
}

TEST_F(SpoolDamage, AFileIsNoDirectory) {
  fs::remove_all(folder_);
  std::ofstream(folder_) << "x";
  EXPECT_EQ(why(spool::Spool::open(folder_, {})), "INTERNAL: " + folder_ + " is not a directory");
  fs::remove(folder_);
  fs::create_directory(folder_);
  std::ofstream(folder_ + "/mill") << "x";
  EXPECT_EQ(why(spool::Spool::open(folder_, {})), "INTERNAL: " + folder_ + "/mill is not a directory");
}

TEST_F(SpoolDamage, OthersMayNotWriteThere) {
  ASSERT_TRUE(upload("abc"));
  for (const std::string& directory : {folder_ + "/mill", folder_}) {
    ASSERT_EQ(::chmod(directory.c_str(), 0707), 0);
    EXPECT_THAT(why(spool::Spool::open(folder_, {})),
                StartsWith("INTERNAL: " + directory + " may be written by everybody on this machine"));
    ASSERT_EQ(::chmod(directory.c_str(), 0700), 0);
  }
}

// Runs `action` on a disk that takes at most `bytes` of a file, and returns its result.
template <class Action>
auto on_full_disk(rlim_t bytes, const Action& action) {
  const FileSizeLimit limit(bytes);
  return action();
}

class SpoolOnAFullDisk : public SpoolDamage {
 protected:
  void SetUp() override { ASSERT_TRUE(upload("good")); }
  void expect_job_1() {
    EXPECT_THAT(files(), ElementsAre("1.json", "1.rml", "last"));
    for (int start = 1; start <= 2; ++start) {
      EXPECT_THAT(ids(), ElementsAre(1));
      EXPECT_EQ(spool_->read("mill", 1).value(), "good");
      EXPECT_EQ(spool_->list("mill").front().facts, R"({"state": "held"})");
      EXPECT_EQ(reopened(), "");
    }
  }
};

TEST_F(SpoolOnAFullDisk, NoNumberIsGiven) {
  auto begun = begin();
  ASSERT_TRUE((*begun)->append("0"));
  EXPECT_EQ(why(on_full_disk(1, [&] { return (*begun)->finish(); })),
            "INTERNAL: cannot write " + path("last.new") + ": File too large");
  begun->reset();
  fs::remove(path("last.new"));
  expect_job_1();
}

TEST_F(SpoolOnAFullDisk, APieceIsRefused) {
  auto begun = begin();
  ASSERT_TRUE((*begun)->append("01234"));
  const std::string refusal = "INTERNAL: cannot write " + path("upload-2") + ": File too large";
  EXPECT_EQ(why(on_full_disk(8, [&] { return (*begun)->append("56789"); })), refusal);
  EXPECT_EQ(why((*begun)->append("56789")), refusal) << "the file has a part of it";
  EXPECT_EQ(why((*begun)->finish()), refusal);
  begun->reset();
  expect_job_1();
}

TEST_F(SpoolOnAFullDisk, AnUploadDoesNotFinish) {
  auto begun = begin();
  ASSERT_TRUE((*begun)->append("01234"));
  EXPECT_EQ(why(on_full_disk(8, [&] { return (*begun)->finish(); })),
            "INTERNAL: cannot write " + path("2.json.new") + ": File too large");
  begun->reset();
  expect_job_1();
}

TEST_F(SpoolOnAFullDisk, FactsStayAsTheyAre) {
  EXPECT_EQ(why(on_full_disk(8, [this] { return spool_->set_facts("mill", 1, "{}"); })),
            "INTERNAL: cannot write " + path("1.json.new") + ": File too large");
  fs::remove(path("1.json.new"));
  expect_job_1();
}

// The job's bytes cannot be unlinked.
TEST_F(SpoolDamage, AJobThatCannotBeRemovedStaysListed) {
  ASSERT_TRUE(upload("good"));
  fs::remove(path("1.rml"));
  fs::create_directory(path("1.rml"));
  EXPECT_EQ(why(spool_->remove("mill", 1)), "INTERNAL: cannot write " + path("1.rml") + ": Is a directory");
  EXPECT_THAT(ids(), ElementsAre(1));
  fs::remove(path("1.rml"));
  EXPECT_TRUE(spool_->remove("mill", 1)) << "what is left of it";
  EXPECT_THAT(ids(), IsEmpty());
  EXPECT_THAT(files(), ElementsAre("last"));
}

TEST_F(SpoolDamage, AJobThatCannotBeDroppedHoldsUpNoOther) {
  ASSERT_TRUE(upload("good"));
  ASSERT_TRUE(upload("good"));
  for (const std::uint64_t id : {1, 2}) ASSERT_TRUE(spool_->end("mill", id, spool_test::kNow));
  fs::remove(path("1.rml"));
  fs::create_directory(path("1.rml"));
  EXPECT_THAT(why(spool_->drop_old(spool_test::kNow + std::chrono::days(30))),
              StartsWith("INTERNAL: cannot write " + path("1.rml")));
  EXPECT_THAT(ids(), ElementsAre(1));
}

}  // namespace
}  // namespace axisgate::server::spool_damage_test
