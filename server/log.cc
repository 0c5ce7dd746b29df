#include "server/log.h"

#include <spdlog/cfg/env.h>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdio>
#include <memory>
#include <mutex>

namespace axisgate::server::log {
namespace {

// spdlog's own sinks for standard error flush every line, which takes five times as long as writing it.
class BufferedStandardError final : public spdlog::sinks::base_sink<std::mutex> {
 public:
  BufferedStandardError() { std::setvbuf(stderr, nullptr, _IOFBF, 64 * 1024); }

 protected:
  void sink_it_(const spdlog::details::log_msg& message) override {
    spdlog::memory_buf_t line;
    formatter_->format(message, line);
    std::fwrite(line.data(), 1, line.size(), stderr);
  }
  void flush_() override { std::fflush(stderr); }
};

constexpr std::array kLevels = {spdlog::level::debug, spdlog::level::info, spdlog::level::warn, spdlog::level::err,
                                spdlog::level::critical};

}  // namespace

void start() {
  auto logger = std::make_shared<spdlog::logger>("axisgated", std::make_shared<BufferedStandardError>());
  logger->set_pattern("%Y-%m-%d %H:%M:%S.%e %l %v");
  logger->flush_on(spdlog::level::warn);
  spdlog::set_default_logger(std::move(logger));
  spdlog::flush_every(std::chrono::seconds(1));
  spdlog::cfg::load_env_levels();
}

void flush() { spdlog::default_logger()->flush(); }

void write(Level level, fmt::string_view format, fmt::format_args arguments) {
  const auto its = kLevels.at(static_cast<std::size_t>(level));
  if (spdlog::should_log(its)) spdlog::log(its, fmt::vformat(format, arguments));
}

}  // namespace axisgate::server::log
