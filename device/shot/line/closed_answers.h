// Bare numbers received between a question and the !:S that closes it (command_row.h, Separation::closed).
#pragma once

#include <algorithm>
#include <iterator>
#include <vector>

namespace axisgate::shot {

// ClosedAnswers separates replies from completions. The numbers of one closed exchange are its reply and completions.
// If all are equal, the reply is that number. If they differ, the replies of other exchanges show which number it is.
class ClosedAnswers {
 public:
  // Adds the numbers of one exchange. Returns the numbers that are certainly completions.
  std::vector<int> take(const std::vector<int>& numbers) {
    const bool alike = std::ranges::count(numbers, numbers.front()) == std::ssize(numbers);
    if (!alike) unclear_.push_back(numbers);
    return alike ? std::vector<int>(numbers.begin() + 1, numbers.end()) : std::vector<int>();
  }
  // Returns the completions among the unclear numbers, now that the reply is known. Exchanges without this reply are
  // ignored: the reply was different at that time.
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

}  // namespace axisgate::shot
