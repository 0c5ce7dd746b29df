// Recognises the kind of a file by its first bytes, in pieces of any size.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "device/jobs/place.h"
#include "device/rml1/check/job_kind.h"

namespace axisgate::rml1 {

class Opening {
 public:
  enum class Verdict : std::uint8_t { nothing_yet, job, g_code, other_file };

  // Keeps as many of the bytes as are needed for a verdict, and returns their number.
  std::size_t take(std::string_view bytes);
  void finish();  // the file ends here

  Verdict verdict() const { return verdict_; }
  const std::string& held() const { return held_; }
  std::string_view what() const { return what_; }                    // kind of another file, such as "a PDF document"
  const jobs::Place& g_code_place() const { return kind_.place(); }  // place of the first word

 private:
  void take(char c);
  void judge_head();

  std::string held_;
  std::string_view what_;
  JobKind kind_;
  Verdict verdict_ = Verdict::nothing_yet;
};

}  // namespace axisgate::rml1
