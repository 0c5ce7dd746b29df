// Program that makes certificates for the tests in Python. Arguments: FOLDER AUTHORITY NAME...
#include <cstdio>
#include <exception>

#include "tests/certificates/authority.h"

int main(int count, char** words) {
  if (count < 3) {
    std::fputs("usage: axisgate-certificates FOLDER AUTHORITY NAME...\n", stderr);
    return 2;
  }
  try {
    const axisgate::Authority authority(words[1], words[2]);
    for (int i = 3; i < count; ++i) authority.issue(words[i]);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
