// Fixture for the tests of server/spool: a spool in a temporary directory, and its files.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "server/spool/spool.h"
#include "tests/unit/link/link_fixtures.h"

namespace axisgate::server::spool_test {

inline constexpr std::chrono::sys_seconds kNow{std::chrono::seconds(1'800'000'000)};

class SpoolBed : public testing::Test {
 protected:
  SpoolBed() { open(); }

  // Opens the spool again, as a restarted daemon does.
  void open(const spool::Bounds& bounds = {}) {
    spool_.reset();
    auto opened = spool::Spool::open(folder_, bounds);
    ASSERT_TRUE(opened) << opened.error().message;
    spool_ = *std::move(opened);
  }
  static spool::NewJob new_job(const std::string& name = "part.rml", const std::string& identity = "unix anna") {
    return {.name = name,
            .who = identity + " (laptop)",
            .identity = identity,
            .facts = R"({"state": "held"})",
            .created = kNow};
  }
  Result<std::unique_ptr<spool::Upload>> begin(const std::string& identity = "unix anna",
                                               const std::string& device = "mill") {
    return spool_->begin(device, new_job("part.rml", identity));
  }
  // Uploads all bytes, in pieces of three.
  Result<spool::Job> upload(std::string_view bytes, const std::string& identity = "unix anna",
                            const std::string& device = "mill") {
    auto begun = begin(identity, device);
    if (!begun) return tl::unexpected(begun.error());
    for (std::size_t at = 0; at < bytes.size(); at += 3) {
      if (const auto appended = (*begun)->append(bytes.substr(at, 3)); !appended) {
        return tl::unexpected(appended.error());
      }
    }
    return (*begun)->finish();
  }
  template <class T>
  static std::string why(const Result<T>& result) {
    return result ? "done" : std::string(name(result.error().reason)) + ": " + result.error().message;
  }

  std::string path(const std::string& name) const { return folder_ + "/mill/" + name; }
  void write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directory(folder_ + "/mill");
    std::ofstream(path(name)) << text;
  }
  std::string content(const std::string& name) const {
    std::ostringstream text;
    text << std::ifstream(path(name)).rdbuf();
    return text.str();
  }
  // Returns the names of the files in the device's directory, in order.
  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_ + "/mill")) {
      names.push_back(entry.path().filename());
    }
    std::ranges::sort(names);
    return names;
  }
  std::vector<std::uint64_t> ids() const {
    std::vector<std::uint64_t> ids;
    for (const spool::Job& job : spool_->list("mill")) ids.push_back(job.id);
    return ids;
  }

  const link_test::TemporaryDirectory directory_;
  const std::string folder_ = directory_ / "spool";
  std::unique_ptr<spool::Spool> spool_;
};

}  // namespace axisgate::server::spool_test
