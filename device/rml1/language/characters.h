// Classes of the bytes of a job (guideline 2-2 to 2-4).
#pragma once

namespace axisgate::rml1 {

inline bool is_letter(char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); }
inline char capital(char letter) { return static_cast<char>(letter & ~0x20); }
inline bool is_digit(char c) { return c >= '0' && c <= '9'; }
inline bool is_blank(char c) { return c == ' ' || c == '\t'; }
inline bool has_eighth_bit(char c) { return (static_cast<unsigned char>(c) & 0x80u) != 0; }
inline bool is_delimiter(char c) { return static_cast<unsigned char>(c) <= 0x20 || c == ';'; }
// Reports whether `c` begins a parameter: a numeral, "+", "-" or ".".
inline bool begins_number(char c) { return is_digit(c) || c == '+' || c == '-' || c == '.'; }

}  // namespace axisgate::rml1
