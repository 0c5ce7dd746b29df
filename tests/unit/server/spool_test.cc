// Jobs on disk: their stored data, and how long they are kept.
#include "server/spool/spool.h"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <atomic>
#include <nlohmann/json.hpp>
#include <thread>

#include "server/spool/job_name.h"
#include "tests/unit/server/spool_bed.h"

namespace axisgate::server::spool_test {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::IsEmpty;

// FIPS 180-2, B.1.
constexpr const char* kHashOfAbc = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";

using Spool = SpoolBed;

TEST_F(Spool, KeepsAJobOverARestart) {
  const auto job = upload("abc");
  ASSERT_TRUE(job) << job.error().message;
  const spool::Job expected{.id = 1,
                            .name = "part.rml",
                            .who = "unix anna (laptop)",
                            .identity = "unix anna",
                            .bytes = 3,
                            .sha256 = kHashOfAbc,
                            .created = kNow,
                            .facts = R"({"state": "held"})"};
  EXPECT_EQ(*job, expected);
  for (int start = 1; start <= 2; ++start) {
    EXPECT_THAT(spool_->list("mill"), ElementsAre(expected));
    EXPECT_EQ(spool_->read("mill", 1).value(), "abc");
    open();
  }
}

TEST_F(Spool, OnDisk) {
  ASSERT_TRUE(upload("PU;\r\n\xFF"));
  ASSERT_TRUE(spool_->end("mill", 1, kNow + 60s));
  EXPECT_THAT(files(), ElementsAre("1.json", "1.rml", "last"));
  EXPECT_EQ(content("1.rml"), "PU;\r\n\xFF");
  EXPECT_EQ(content("last"), "1\n");
  const auto record = nlohmann::json::parse(content("1.json"));
  EXPECT_EQ(record.size(), 9u);
  EXPECT_EQ(record["id"], 1);
  EXPECT_EQ(record["name"], "part.rml");
  EXPECT_EQ(record["who"], "unix anna (laptop)");
  EXPECT_EQ(record["identity"], "unix anna");
  EXPECT_EQ(record["bytes"], 6);
  EXPECT_EQ(record["created"], 1'800'000'000);
  EXPECT_EQ(record["ended"], 1'800'000'060);
  EXPECT_EQ(record["facts"], R"({"state": "held"})");
}

TEST_F(Spool, IsOfTheDaemonsUserAlone) {
  const mode_t before = ::umask(0);
  fs::remove_all(folder_);
  open();
  auto begun = begin();
  ASSERT_TRUE(begun);
  EXPECT_EQ(fs::status(path("upload-1")).permissions(), fs::perms::owner_read | fs::perms::owner_write);
  ASSERT_TRUE((*begun)->finish());
  ::umask(before);
  for (const char* name : {"", "/mill"}) EXPECT_EQ(fs::status(folder_ + name).permissions(), fs::perms::owner_all);
  for (const std::string& name : files()) {
    EXPECT_EQ(fs::status(path(name)).permissions(), fs::perms::owner_read | fs::perms::owner_write) << name;
  }
}

TEST_F(Spool, AJobIsThereWhenItsUploadHasFinished) {
  auto begun = begin();
  ASSERT_TRUE(begun);
  ASSERT_TRUE((*begun)->append("abc"));
  EXPECT_THAT(ids(), IsEmpty());
  EXPECT_FALSE(fs::exists(path("1.json")));
  ASSERT_TRUE((*begun)->finish());
  EXPECT_THAT(ids(), ElementsAre(1));
}

TEST_F(Spool, FactsThatAreKnownAtTheEndOfAnUpload) {
  auto begun = begin();
  ASSERT_TRUE(begun);
  (*begun)->set_facts("{}");
  ASSERT_TRUE((*begun)->finish());
  open();
  EXPECT_EQ(spool_->list("mill").front().facts, "{}");
}

TEST_F(Spool, AnAbandonedUploadLeavesNothing) {
  auto begun = begin();
  ASSERT_TRUE((*begun)->append("abc"));
  EXPECT_EQ(content("upload-1"), "abc");
  begun->reset();
  EXPECT_THAT(files(), IsEmpty());
  EXPECT_EQ(upload("d")->id, 1u) << "it had no number";
}

TEST_F(Spool, WhatHasComeIsReadBackBeforeTheEnd) {
  auto begun = begin();
  ASSERT_TRUE((*begun)->append("abc"));
  std::string read;
  ASSERT_TRUE((*begun)->read_back([&read](std::string_view piece) { read += piece; }));
  EXPECT_EQ(read, "abc");
  ASSERT_TRUE((*begun)->append("de"));
  ASSERT_TRUE((*begun)->finish());
  EXPECT_EQ(spool_->read("mill", 1).value(), "abcde");
}

TEST_F(Spool, TwoUploadsAtOnce) {
  auto first = begin(), second = begin();
  for (int piece = 0; piece < 3; ++piece) {
    ASSERT_TRUE((*first)->append("a"));
    ASSERT_TRUE((*second)->append("bb"));
  }
  EXPECT_EQ((*second)->finish()->id, 1u) << "in the order of their ends";
  EXPECT_EQ((*first)->finish()->id, 2u);
  EXPECT_THAT(ids(), ElementsAre(1, 2));
  EXPECT_EQ(spool_->read("mill", 1).value(), "bbbbbb");
  EXPECT_EQ(spool_->read("mill", 2).value(), "aaa");
}

TEST_F(Spool, DevicesAreNumberedEachByThemselves) {
  EXPECT_EQ(upload("a")->id, 1u);
  EXPECT_EQ(upload("b")->id, 2u);
  EXPECT_EQ(upload("c", "unix anna", "lathe")->id, 1u);
  EXPECT_EQ(spool_->read("lathe", 1).value(), "c");
  EXPECT_THAT(spool_->list("laser"), IsEmpty());
}

TEST_F(Spool, ANumberIsNeverGivenTwice) {
  ASSERT_TRUE(upload("a"));
  ASSERT_TRUE(upload("b"));
  ASSERT_TRUE(spool_->remove("mill", 2));
  EXPECT_EQ(upload("c")->id, 3u);
  ASSERT_TRUE(spool_->remove("mill", 3));
  ASSERT_TRUE(spool_->remove("mill", 1));
  open();
  EXPECT_EQ(upload("d")->id, 4u);
}

TEST_F(Spool, FactsAreReplaced) {
  ASSERT_TRUE(upload("abc"));
  ASSERT_TRUE(spool_->set_facts("mill", 1, R"({"state": "queued", "note": "für Ömer"})"));
  for (int start = 1; start <= 2; ++start) {
    EXPECT_EQ(spool_->list("mill").front().facts, R"({"state": "queued", "note": "für Ömer"})");
    EXPECT_EQ(spool_->read("mill", 1).value(), "abc");
    open();
  }
  EXPECT_THAT(files(), ElementsAre("1.json", "1.rml", "last"));
}

TEST_F(Spool, AJobEndsOnce) {
  ASSERT_TRUE(upload("abc"));
  EXPECT_FALSE(spool_->list("mill").front().ended);
  ASSERT_TRUE(spool_->end("mill", 1, kNow + 1h));
  ASSERT_TRUE(spool_->end("mill", 1, kNow + 2h));
  for (int start = 1; start <= 2; ++start) {
    EXPECT_EQ(spool_->list("mill").front().ended, kNow + 1h);
    open();
  }
}

TEST_F(Spool, WhatHasEndedIsDroppedAfterItsTime) {
  for (int job = 1; job <= 3; ++job) ASSERT_TRUE(upload("abc"));
  ASSERT_TRUE(spool_->end("mill", 1, kNow));
  ASSERT_TRUE(spool_->end("mill", 2, kNow + 1s));
  ASSERT_TRUE(spool_->drop_old(kNow + 720h - 1s));
  EXPECT_THAT(ids(), ElementsAre(1, 2, 3));
  ASSERT_TRUE(spool_->drop_old(kNow + 720h));
  EXPECT_THAT(ids(), ElementsAre(2, 3));
  ASSERT_TRUE(spool_->drop_old(kNow + 100'000h));
  EXPECT_THAT(ids(), ElementsAre(3)) << "it has not ended";
  EXPECT_THAT(files(), ElementsAre("3.json", "3.rml", "last"));
}

TEST_F(Spool, WhatIsNotThere) {
  ASSERT_TRUE(upload("abc"));
  ASSERT_TRUE(spool_->remove("mill", 1));
  EXPECT_EQ(why(spool_->read("mill", 1)), "NOT_FOUND: there is no job 1 on \"mill\"");
  EXPECT_EQ(why(spool_->set_facts("mill", 1, "{}")), "NOT_FOUND: there is no job 1 on \"mill\"");
  EXPECT_EQ(why(spool_->end("mill", 1, kNow)), "NOT_FOUND: there is no job 1 on \"mill\"");
  EXPECT_EQ(why(spool_->remove("laser", 1)), "NOT_FOUND: there is no job 1 on \"laser\"");
  EXPECT_EQ(why(spool_->begin("../mill", new_job())), "UNKNOWN_DEVICE: there is no device \"../mill\"");
  EXPECT_THAT(files(), ElementsAre("last"));
}

TEST_F(Spool, IsUsedByManyThreads) {
  std::atomic<int> wrong = 0;
  std::atomic<bool> ending = false;
  const auto write = [&](const std::string& identity) {
    for (int i = 0; i < 30; ++i) {
      const auto job = upload(identity, identity);
      if (!job || !spool_->set_facts("mill", job->id, "{}") || !spool_->remove("mill", job->id)) ++wrong;
    }
  };
  const auto read = [&] {
    while (!ending) {
      for (const spool::Job& job : spool_->list("mill")) {
        const auto bytes = spool_->read("mill", job.id);
        if (bytes ? *bytes != job.identity : bytes.error().reason != Reason::not_found) ++wrong;
      }
    }
  };
  // Many readers, so that some are interrupted between finding a job and opening its file.
  std::vector<std::thread> readers;
  for (int i = 0; i < 8; ++i) readers.emplace_back(read);
  std::thread anna(write, "unix anna"), bert(write, "unix bert");
  anna.join();
  bert.join();
  ending = true;
  for (std::thread& reader : readers) reader.join();
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(begin()->get()->finish()->id, 61u);
}

TEST_F(Spool, ChangesOfOneJobAreMadeOneAfterTheOther) {
  ASSERT_TRUE(upload("abc"));
  std::atomic<int> refused = 0;
  const auto change = [&](const std::string& facts) {
    for (int i = 0; i < 50; ++i) {
      if (!spool_->set_facts("mill", 1, facts)) ++refused;
    }
  };
  std::thread first(change, "1"), second(change, "2");
  first.join();
  second.join();
  EXPECT_EQ(refused, 0);
  const auto before = spool_->list("mill");
  open();
  EXPECT_EQ(spool_->list("mill"), before);
}

std::string named(std::string_view text) {
  const auto name = spool::job_name(text);
  return name ? *name : name.error().message;
}

TEST(JobNames, AreTakenAsTheyAre) {
  const std::string longest = std::string(98, 'x') + "\u00E4";
  for (const std::string& name :
       {std::string("part.rml"), std::string("Teil 3 (für Ömer)"), std::string("部品.rml"), std::string("a:b*?\"<>|"),
        std::string("a.."), std::string("\U0010FFFF\uD7FF\uE000"), longest}) {
    EXPECT_EQ(named(name), name);
  }
}

TEST(JobNames, OfAPathAreItsLastPart) {
  EXPECT_EQ(named("C:\\jobs\\part.rml"), "part.rml");
  EXPECT_EQ(named("/srv/jobs/part.rml"), "part.rml");
  EXPECT_EQ(named("..\\../part.rml"), "part.rml");
  EXPECT_EQ(named("  part 3.rml "), "part 3.rml");
  EXPECT_EQ(named(std::string(200, 'x') + "/part.rml"), "part.rml");
}

TEST(JobNames, ThatAreRefused) {
  const std::string none = "that is not a name for a job: ";
  for (const char* empty : {"", "  ", "jobs/", "C:\\"}) EXPECT_EQ(named(empty), none + "it is empty");
  for (const char* dots : {".", "..", "../..", " .hidden"}) EXPECT_EQ(named(dots), none + "it begins with a dot");
  EXPECT_EQ(named(std::string(99, 'x') + "\u00E4"), none + "it has 101 bytes");
  EXPECT_EQ(named(std::string_view("a\0b", 3)), none + "it has the control character U+0000");
  EXPECT_EQ(named("a\x1B[2J"), none + "it has the control character U+001B");
  EXPECT_EQ(named("a\x7F"), none + "it has the control character U+007F");
  EXPECT_EQ(named("a\u009B"), none + "it has the control character U+009B");
  EXPECT_EQ(named("a\u2028"), none + "it has the control character U+2028");
  EXPECT_EQ(named("lmr\u202E.trap"), none + "it has the control character U+202E");
  EXPECT_EQ(named("a\u2066"), none + "it has the control character U+2066");
  for (const char* bytes : {"\x80", "\xFF", "\xC3", "\xE4\xBA", "\xC3(", "\xC0\xAF", "\xE0\x80\xAF", "\xF0\x80\x80\xAF",
                            "\xED\xA0\x80", "\xF4\x90\x80\x80", "\xF8\x88\x80\x80\x80"}) {
    EXPECT_EQ(named(bytes), none + "it is not UTF-8");
  }
  EXPECT_EQ(spool::job_name("").error().hint,
            "use 1 to 100 bytes of UTF-8 without control characters, not beginning with a dot");
}

}  // namespace
}  // namespace axisgate::server::spool_test
