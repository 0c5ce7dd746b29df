// The bare numbers that come between a question and the !:S that closes it (command_table.h, Separation::closed).
#pragma once

#include <algorithm>
#include <iterator>
#include <vector>

namespace axisgate::shrc203 {

// The numbers of one closed exchange are its answer, and completions. Where they are all alike, the answer is that
// number. Where they differ, the answers of the other exchanges show which one it is.
class ClosedAnswers {
 public:
  // What of them are completions for certain.
  std::vector<int> take(const std::vector<int>& numbers) {
    const bool alike = std::ranges::count(numbers, numbers.front()) == std::ssize(numbers);
    if (!alike) unclear_.push_back(numbers);
    return alike ? std::vector<int>(numbers.begin() + 1, numbers.end()) : std::vector<int>();
  }
  // ... and of those that were not clear, once the answer is known. If it was another then, nothing follows from it.
  std::vector<int> settle(int answer) {
    std::vector<int> completions;
    for (std::vector<int>& numbers : unclear_) {
      const auto own = std::ranges::find(numbers, answer);
      if (own == numbers.end()) continue;
      numbers.erase(own);
      completions.insert(completions.end(), numbers.begin(), numbers.end());
    }
    unclear_.clear();
    return completions;
  }

 private:
  std::vector<std::vector<int>> unclear_;
};

}  // namespace axisgate::shrc203
