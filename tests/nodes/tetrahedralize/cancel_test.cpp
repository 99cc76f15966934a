// Ctrl-C must be answered at once, whatever the step is busy with.
#include <gtest/gtest.h>

#include <chrono>
#include <ctime>
#include <thread>

#include "surfaces.h"

namespace sherd::test {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

struct Answer {
  bool ok, cancelled;
  double delay;  ///< s of processor time from the cancellation to the return: a busy machine shall not count
};

/// Runs the step and cancels it from another thread after `wait`.
Answer cancelAfter(const std::shared_ptr<const TriMesh>& mesh, const TetrahedralizeParams& params,
                   Seconds wait) {
  CancelToken token;
  Exec exec;
  exec.cancel = &token;
  std::clock_t cancelledAt = 0;
  std::thread user([&] {
    std::this_thread::sleep_for(wait);
    cancelledAt = std::clock();
    token.cancel();
  });
  const auto cage = tetrahedralize(mesh, params, exec);
  const std::clock_t returned = std::clock();
  user.join();
  return {cage.ok(), !cage.ok() && cage.error().kind == Error::Kind::Cancelled,
          static_cast<double>(returned - cancelledAt) / CLOCKS_PER_SEC};
}

TEST(TetrahedralizeCancel, BeforeTheStart) {
  CancelToken cancel;
  cancel.cancel();
  Exec exec;
  exec.cancel = &cancel;
  const auto cage = tetrahedralize(shared(sphere(Vec3::Zero(), 1)), {}, exec);
  ASSERT_FALSE(cage.ok());
  EXPECT_EQ(cage.error().kind, Error::Kind::Cancelled);
}

TEST(TetrahedralizeCancel, AtAnyTimeOfARun) {
  const auto mesh = shared(torus(1, 0.4));
  const TetrahedralizeParams params{.tets = 500};
  const Clock::time_point start = Clock::now();
  ASSERT_TRUE(tetrahedralize(mesh, params, {}).ok());
  const Seconds whole = Clock::now() - start;
  constexpr int kDelays = 12;
  int cancelled = 0;
  for (int i = 0; i < kDelays; ++i) {
    const Answer answer = cancelAfter(mesh, params, whole * ((i + 0.5) / kDelays));
    EXPECT_TRUE(answer.ok || answer.cancelled);
    if (answer.ok) continue;  // the run was faster than the first one
    ++cancelled;
    EXPECT_LT(answer.delay, 0.3) << "cancelled at " << (i + 0.5) / kDelays << " of the run";
  }
  EXPECT_GE(cancelled, kDelays / 2);
}

}  // namespace
}  // namespace sherd::test
