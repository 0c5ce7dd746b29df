#include "device/rml1/job_kind.h"

namespace axisgate::rml1 {
namespace {

// Of the byte order mark that some editors put before a text.
bool is_mark(char c) { return c == '\xEF' || c == '\xBB' || c == '\xBF'; }

}  // namespace

JobKind::Told JobKind::take(char c) {
  if (told_ != Told::nothing_yet) return told_;
  told_ = judge(c);
  next_ =
      c == '\n' ? Place{next_.offset + 1, next_.line + 1, 1} : Place{next_.offset + 1, next_.line, next_.column + 1};
  if (told_ == Told::nothing_yet && next_.offset == kLongest) told_ = Told::rml;
  return told_;
}

JobKind::Told JobKind::judge(char c) {
  if (in_ == In::comment) {
    if (c == '\n') in_ = In::blanks;
    return Told::nothing_yet;
  }
  if (in_ == In::letter) return judge_behind_letter(c);
  if (in_ == In::number && (is_digit(c) || c == '.')) return Told::nothing_yet;
  word_ = next_;
  if (c == '%' || c == '(') return Told::g_code;
  if (is_letter(c)) {
    letter_ = capital(c);
    in_ = In::letter;
  } else if (c == ';') {
    in_ = In::comment;
  } else if (is_delimiter(c) || is_mark(c)) {
    in_ = In::blanks;
  } else {
    return Told::rml;
  }
  return Told::nothing_yet;
}

JobKind::Told JobKind::judge_behind_letter(char c) {
  if (is_blank(c)) return Told::nothing_yet;
  if (!begins_number(c)) return Told::rml;
  const bool only_g_code = letter_ == 'G' || letter_ == 'N' || letter_ == 'O';
  if (only_g_code) return is_digit(c) ? Told::g_code : Told::rml;
  in_ = In::number;
  return Told::nothing_yet;
}

}  // namespace axisgate::rml1
