#include "tests/bench/callers.h"

#include <atomic>
#include <chrono>
#include <exception>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "tests/bench/measurement.h"

namespace axisgate::bench {
namespace {

void sleep_seconds(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

class Callers {
 public:
  Callers(const Load& load, const MakeAsk& make_ask) : load_(load), make_ask_(make_ask) {}

  nlohmann::json measure() {
    std::vector<std::thread> threads;
    for (int caller = 0; caller < load_.callers; ++caller) threads.emplace_back([this, caller] { call(caller); });
    sleep_seconds(load_.warm_up);
    phase_ = Phase::measuring;
    say_begun();
    const auto begun = Clock::now();
    sleep_seconds(load_.seconds);
    phase_ = Phase::over;
    const std::chrono::duration<double> took = Clock::now() - begun;
    say_ended();
    for (auto& thread : threads) thread.join();
    if (!failure_.empty()) throw std::runtime_error(failure_);
    auto figures = latencies_.summary();
    figures["per_second"] = figures["count"].get<double>() / took.count();
    figures["calls"] = calls_.load();
    return figures;
  }

 private:
  enum class Phase { warming_up, measuring, over };

  void call(int caller) {
    Latencies own;
    try {
      ask_until_over(make_ask_(caller), own);
    } catch (const std::exception& error) {
      const std::lock_guard lock(mutex_);
      if (failure_.empty()) failure_ = error.what();
    }
    const std::lock_guard lock(mutex_);
    latencies_.add(own);
  }

  // Counts the questions that begin within the measured time: as many are in progress at its end as at its beginning.
  void ask_until_over(const Ask& ask, Latencies& own) {
    while (phase_ != Phase::over) {
      const bool counts = phase_ == Phase::measuring;
      const auto asked = Clock::now();
      ask();
      if (counts) own.add(Clock::now() - asked);
      ++calls_;
      if (load_.pause_ms > 0) std::this_thread::sleep_for(std::chrono::milliseconds(load_.pause_ms));
    }
  }

  const Load load_;
  const MakeAsk& make_ask_;
  std::atomic<Phase> phase_ = Phase::warming_up;
  std::atomic<int> calls_ = 0;
  std::mutex mutex_;
  Latencies latencies_;
  std::string failure_;  // the first failure
};

}  // namespace

nlohmann::json measure_callers(const Load& load, const MakeAsk& make_ask) { return Callers(load, make_ask).measure(); }

}  // namespace axisgate::bench
