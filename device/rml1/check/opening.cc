#include "device/rml1/check/opening.h"

#include "device/rml1/check/known_file.h"

namespace axisgate::rml1 {
namespace {

Opening::Verdict verdict_of(JobKind::Verdict kind) {
  switch (kind) {
    case JobKind::Verdict::nothing_yet:
      return Opening::Verdict::nothing_yet;
    case JobKind::Verdict::g_code:
      return Opening::Verdict::g_code;
    case JobKind::Verdict::rml:
      break;
  }
  return Opening::Verdict::job;
}

}  // namespace

std::size_t Opening::take(std::string_view bytes) {
  std::size_t count = 0;
  while (verdict_ == Verdict::nothing_yet && count < bytes.size()) take(bytes[count++]);
  return count;
}

void Opening::take(char c) {
  held_ += c;
  if (held_.size() > kHead) {
    verdict_ = verdict_of(kind_.take(c));
  } else if (held_.size() == kHead) {
    judge_head();
  }
}

void Opening::judge_head() {
  if (const auto known = known_file(held_)) {
    what_ = *known;
    verdict_ = Verdict::other_file;
    return;
  }
  for (const char c : held_) verdict_ = verdict_of(kind_.take(c));
}

void Opening::finish() {
  if (held_.size() < kHead) judge_head();
  if (verdict_ == Verdict::nothing_yet) verdict_ = Verdict::job;
}

}  // namespace axisgate::rml1
