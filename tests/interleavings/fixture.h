// Fixture that tries every order for many questions, and prints the numbers of orders and questions.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdio>
#include <functional>
#include <vector>

#include "device/shot/command/reply.h"
#include "device/shrc203/command/command_table.h"
#include "tests/interleavings/interleaving.h"

namespace axisgate::simulation {

class Interleavings : public testing::Test {
 protected:
  using Axes = stage::AxisSet;

  ~Interleavings() override {
    std::printf("%llu interleavings of %llu questions\n", static_cast<unsigned long long>(tried_),
                static_cast<unsigned long long>(questions_));
  }

  static std::vector<Axes> subsets(Axes axes) {
    std::vector<Axes> sets = {{}};
    for (const int axis : axes.list()) {
      const std::vector<Axes> without = sets;
      for (const Axes set : without) sets.push_back(set | Axes::of(axis));
    }
    sets.erase(sets.begin());
    return sets;
  }
  // Returns a set of one, of two and of three axes.
  static std::vector<Axes> counts() { return {Axes::of(1), Axes::of(1) | Axes::of(2), shrc203::kAllAxes}; }

  // Tries every order for one question, and reports the first failure.
  void try_all(const Question& question) {
    ++questions_;
    Choices choices;
    do {
      Interleaving interleaving(question, choices);
      const std::string failure = interleaving.run();
      ++tried_;
      if (!failure.empty()) {
        ADD_FAILURE() << question.description() << "\n in the order" << interleaving.order() << "\n " << failure;
        return;
      }
    } while (choices.another());
  }

  // Calls `take` with each possible question about the chosen rows and sets of controllable axes.
  static void each_question(const std::function<bool(const shrc203::CommandRow&)>& chosen,
                            const std::vector<Axes>& controllable_sets, const std::function<void(Question)>& take) {
    for (const shrc203::CommandRow& row : shrc203::model().commands()) {
      if (!shrc203::bare_number_range(row) || !chosen(row)) continue;
      for (const Axes controllable : controllable_sets) {
        for (const Axes moving : subsets(controllable)) {
          for (const int value : values_of(row)) {
            Question question;
            question.row = &row;
            question.value = value;
            question.controllable = controllable;
            question.moving = moving;
            take(question);
          }
        }
      }
    }
  }

  static bool every_row(const shrc203::CommandRow&) { return true; }
  static bool closed_rows(const shrc203::CommandRow& row) { return row.separation == shrc203::Separation::closed; }
  static bool rows_of_host(const shrc203::CommandRow& row) { return row.needs.mode == shrc203::Mode::host; }

 private:
  std::uint64_t questions_ = 0, tried_ = 0;
};

}  // namespace axisgate::simulation
