// Two pollers and one mover at the same controller, each with a different question whose answer is known: the number of
// replies that belong to another client. The clients use the daemon, or share one raw port.
#include <fmt/format.h>

#include <array>
#include <atomic>
#include <chrono>
#include <exception>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "tests/bench/daemon.h"
#include "tests/bench/measurement.h"
#include "tests/bench/raw_line.h"
#include "tests/bench/subcommands.h"

namespace axisgate::bench {
namespace {

struct Options {
  std::string target;
  bool raw = false;
  int count = 5000;
};

// A Client is one program that uses the controller.
class Client {
 public:
  virtual ~Client() = default;
  virtual std::string ask(const std::string& line) = 0;
  // Makes a short move of axis 3, waits for its end, and returns the answers to the setting and to the start.
  virtual std::vector<std::string> move() = 0;
};

const std::vector<std::string> kMove = {"M:3+P10", "G:3"};

class ClientOfDaemon final : public Client {
 public:
  explicit ClientOfDaemon(const std::string& target) : stub_(v1::CommandService::NewStub(connect(target))) {}
  std::string ask(const std::string& line) override { return execute(*stub_, {line}).at(0); }
  std::vector<std::string> move() override { return execute(*stub_, kMove); }

 private:
  std::unique_ptr<v1::CommandService::Stub> stub_;
};

// Client of the raw port, as careful as possible: it discards bytes received before its question.
class ClientOfPort final : public Client {
 public:
  explicit ClientOfPort(const std::string& address) : line_(RawLine::connect_tcp(address)) {}
  std::string ask(const std::string& line) override {
    line_.discard_received();
    return line_.ask(line).value_or("nothing");
  }
  std::vector<std::string> move() override {
    std::vector<std::string> answers;
    for (const std::string& line : kMove) answers.push_back(ask(line));
    constexpr auto kLonger = std::chrono::milliseconds(20);  // longer than the move, which takes 11 ms
    std::this_thread::sleep_for(kLonger);
    return answers;
  }

 private:
  RawLine line_;
};

std::unique_ptr<Client> make_client(const Options& options) {
  if (options.raw) return std::make_unique<ClientOfPort>(options.target);
  return std::make_unique<ClientOfDaemon>(options.target);
}

class Measurement {
 public:
  explicit Measurement(const Options& options) : options_(options) {}

  nlohmann::json run() {
    give_each_axis_its_answer();
    say_begun();
    const auto begun = Clock::now();
    std::vector<std::thread> threads;
    threads.emplace_back([this] { as_client([this](Client& client) { poll(client, 1); }); });
    threads.emplace_back([this] { as_client([this](Client& client) { poll(client, 2); }); });
    threads.emplace_back([this] { as_client([this](Client& client) { move_and_poll(client); }); });
    for (auto& thread : threads) thread.join();
    const std::chrono::duration<double> took = Clock::now() - begun;
    say_ended();
    if (!failure_.empty()) throw std::runtime_error(failure_);
    const int replies = replies_;
    return {{"count", replies}, {"wrong", wrong_.load()}, {"per_second", replies / took.count()}, {"first", first_}};
  }

 private:
  static std::string question(int axis) { return fmt::format("?:D{}", axis); }

  // Sets a different minimum speed for each axis, and reads the expected answers before other clients ask.
  void give_each_axis_its_answer() {
    const auto alone = make_client(options_);
    for (int axis = 1; axis <= 3; ++axis) {
      expect(alone->ask(fmt::format("D:{}S{}F50000R100", axis, 1000 + 100 * axis)), "OK", "the setting of a speed");
      expected_[static_cast<std::size_t>(axis - 1)] = alone->ask(question(axis));
    }
    if (expected_[0] == expected_[1] || expected_[1] == expected_[2]) throw std::runtime_error("equal answers");
  }

  static void expect(const std::string& answer, const std::string& expected, const std::string& what) {
    if (answer != expected) throw std::runtime_error(fmt::format("{} was answered by {}", what, answer));
  }

  template <class Work>
  void as_client(Work work) {
    try {
      const auto client = make_client(options_);
      while (replies_ < options_.count && !failed_) work(*client);
    } catch (const std::exception& error) {
      const std::lock_guard lock(mutex_);
      failed_ = true;
      failure_ = error.what();
    }
  }

  void poll(Client& client, int axis) {
    count(question(axis), client.ask(question(axis)), expected_[static_cast<std::size_t>(axis - 1)]);
  }

  void move_and_poll(Client& client) {
    const auto answers = client.move();
    for (std::size_t i = 0; i < answers.size(); ++i) count(kMove[i], answers[i], "OK");
    poll(client, 3);
  }

  void count(const std::string& asked, const std::string& answer, const std::string& expected) {
    ++replies_;
    if (answer == expected) return;
    ++wrong_;
    const std::lock_guard lock(mutex_);
    if (first_.empty()) first_ = fmt::format("{} was answered by {}", asked, answer);
  }

  const Options options_;
  std::array<std::string, 3> expected_;
  std::atomic<int> replies_ = 0, wrong_ = 0;
  std::atomic<bool> failed_ = false;
  std::mutex mutex_;
  std::string first_;  // the first wrong reply
  std::string failure_;
};

}  // namespace

void add_wrong_replies(CLI::App& program) {
  CLI::App& sub = *program.add_subcommand("wrong_replies", "Two pollers and a mover: whose reply does each receive?");
  const auto options = std::make_shared<Options>();
  sub.add_option("--target", options->target, "unix:PATH or HOST:PORT")->required();
  sub.add_flag("--raw", options->raw, "The target is the raw port of a serial server");
  sub.add_option("--count", options->count, "How many replies")->check(CLI::PositiveNumber);
  sub.callback([options] { print(Measurement(*options).run()); });
}

}  // namespace axisgate::bench
