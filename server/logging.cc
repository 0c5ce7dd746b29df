#include "server/logging.h"

#include <spdlog/cfg/env.h>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <cstdio>
#include <memory>
#include <mutex>

namespace axisgate::server {
namespace {

// spdlog's own sinks for standard error flush every line, which costs five times as much as writing it.
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

}  // namespace

void start_logging() {
  auto logger = std::make_shared<spdlog::logger>("axisgated", std::make_shared<BufferedStandardError>());
  logger->set_pattern("%Y-%m-%d %H:%M:%S.%e %l %v");
  logger->flush_on(spdlog::level::warn);
  spdlog::set_default_logger(std::move(logger));
  spdlog::flush_every(std::chrono::seconds(1));
  spdlog::cfg::load_env_levels();
}

}  // namespace axisgate::server
