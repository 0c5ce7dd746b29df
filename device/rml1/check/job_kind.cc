#include "device/rml1/check/job_kind.h"

namespace axisgate::rml1 {
namespace {

// Reports whether the byte belongs to the byte order mark that some editors put before a text.
bool is_mark(char c) { return c == '\xEF' || c == '\xBB' || c == '\xBF'; }

}  // namespace

JobKind::Verdict JobKind::take(char c) {
  if (verdict_ != Verdict::nothing_yet) return verdict_;
  verdict_ = judge(c);
  next_ = after(next_, c);
  if (verdict_ == Verdict::nothing_yet && next_.offset == kLongest) verdict_ = Verdict::rml;
  return verdict_;
}

JobKind::Verdict JobKind::judge(char c) {
  if (in_ == In::comment) {
    if (c == '\n') in_ = In::blanks;
    return Verdict::nothing_yet;
  }
  if (in_ == In::letter) return judge_after_letter(c);
  if (in_ == In::number && (is_digit(c) || c == '.')) return Verdict::nothing_yet;
  word_ = next_;
  if (c == '%' || c == '(') return Verdict::g_code;
  if (is_letter(c)) {
    letter_ = capital(c);
    in_ = In::letter;
  } else if (c == ';') {
    in_ = In::comment;
  } else if (is_delimiter(c) || is_mark(c)) {
    in_ = In::blanks;
  } else {
    return Verdict::rml;
  }
  return Verdict::nothing_yet;
}

JobKind::Verdict JobKind::judge_after_letter(char c) {
  if (is_blank(c)) return Verdict::nothing_yet;
  if (!begins_number(c)) return Verdict::rml;
  const bool only_g_code = letter_ == 'G' || letter_ == 'N' || letter_ == 'O';
  if (only_g_code) return is_digit(c) ? Verdict::g_code : Verdict::rml;
  in_ = In::number;
  return Verdict::nothing_yet;
}

}  // namespace axisgate::rml1
