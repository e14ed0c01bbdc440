#include "dem/stray_balls.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace sandflow {
namespace {

SearchBall randomBall(std::mt19937& random, double halfWidth)
{
    std::uniform_real_distribution<double> place(-halfWidth, halfWidth);
    std::uniform_real_distribution<float> reach(0.005f, 0.03f);
    const double x = place(random), y = place(random), z = place(random);
    return {x, y, z, reach(random), 0};
}

/// Few balls are gone through one by one, many are looked up by cell: both find all that meet.
TEST(StrayBalls, FindsEveryBallThatMeets)
{
    std::mt19937 random(3);
    for (const std::uint32_t count : {5u, 60u, 3000u}) {
        StrayBalls strays(0.015);
        std::vector<SearchBall> balls;
        for (std::uint32_t n = 0; n < count; ++n) {
            balls.push_back(randomBall(random, 0.15));
            strays.add(n, balls.back());
        }
        std::size_t met = 0;
        for (int k = 0; k < 400; ++k) {
            const SearchBall ball = randomBall(random, 0.2);
            std::multiset<std::uint32_t> expected, found;
            for (std::uint32_t n = 0; n < count; ++n) {
                if (balls[n].meets(ball)) {
                    expected.insert(n);
                }
            }
            strays.visitMeeting(ball, [&](std::uint32_t n) { found.insert(n); });
            ASSERT_EQ(found, expected);
            met += found.size();
        }
        EXPECT_GT(met, 0u) << count;
        strays.clear();
        strays.visitMeeting(balls[0], [](std::uint32_t) { FAIL() << "nothing is left"; });
    }
}

TEST(StrayBalls, AGrainHasSeveral)
{
    StrayBalls strays(0.015);
    strays.add(7, {0.0, 0.0, 0.0, 0.01f, 70});
    strays.add(8, {1.0, 0.0, 0.0, 0.01f, 80});
    strays.add(7, {2.0, 0.0, 0.0, 0.01f, 70});
    const auto near = [](double x) {
        return [x](const SearchBall& ball) { return std::abs(ball.x - x) < 0.1; };
    };
    EXPECT_TRUE(strays.anyOf(7, near(0.0)));
    EXPECT_TRUE(strays.anyOf(7, near(2.0)));
    EXPECT_FALSE(strays.anyOf(7, near(1.0)));
    EXPECT_FALSE(strays.anyOf(9, near(0.0)));
    EXPECT_EQ(strays.size(), 3u);
}

}  // namespace
}  // namespace sandflow
