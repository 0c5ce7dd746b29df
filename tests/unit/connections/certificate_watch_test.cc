// Times at which the log warns that the certificate expires.
#include "server/connections/certificate_watch.h"

#include <gtest/gtest.h>

#include <chrono>

#include "server/connections/certificates.h"
#include "tests/certificates/authority.h"
#include "tests/unit/link/link_fixtures.h"

namespace axisgate::server::certificate_watch_test {
namespace {

using std::chrono::days;
using std::chrono::hours;
using std::chrono::seconds;

const WallTime kNow = std::chrono::sys_days(std::chrono::year(2026) / 3 / 1);

CertificateNotice notice(Duration left) {
  return notice_of("gateway.crt", kNow + std::chrono::duration_cast<WallTime::duration>(left), kNow);
}

TEST(CertificateWatch, SaysNothingForLong) {
  const CertificateNotice good = notice(days(14) + seconds(1));
  EXPECT_EQ(good.text, "");
  EXPECT_EQ(good.next_look, days(1));
}

TEST(CertificateWatch, WarnsDailyInTheLastTwoWeeks) {
  const CertificateNotice soon = notice(days(14));
  EXPECT_EQ(soon.text,
            "the certificate gateway.crt expires at 2026-03-15 00:00:00 UTC; callers from the network can then no "
            "longer connect; replace it and its key, no restart is needed");
  EXPECT_EQ(soon.next_look, days(1));
}

TEST(CertificateWatch, LooksAgainWhenItExpires) {
  EXPECT_EQ(notice(hours(3)).next_look, hours(3) + seconds(1));
  EXPECT_EQ(notice(seconds(0)).next_look, days(1)) << "then daily";
  EXPECT_EQ(notice(-hours(5)).text,
            "the certificate gateway.crt expired at 2026-02-28 19:00:00 UTC; callers from the network can no longer "
            "connect; replace it and its key, no restart is needed");
}

TEST(CertificateWatch, ReadsTheFile) {
  const link_test::TemporaryDirectory folder;
  Authority(folder / "", "lab").issue("gateway");
  const std::string path = folder / "gateway.crt";
  const Result<WallTime> until = expiry(path);
  ASSERT_TRUE(until) << until.error().message;
  EXPECT_EQ(notice_of(path, until, *until - days(15)).text, "");
  EXPECT_EQ(notice_of(path, until, *until).text.find("the certificate " + path + " expired at "), 0u);
  const CertificateNotice gone = notice_of("/nowhere.crt", expiry("/nowhere.crt"), kNow);
  EXPECT_EQ(gone.text.find("/nowhere.crt cannot be opened: No such file"), 0u) << gone.text;
  EXPECT_EQ(gone.next_look, days(1));
}

}  // namespace
}  // namespace axisgate::server::certificate_watch_test
