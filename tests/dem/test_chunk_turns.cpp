#include "dem/chunk_turns.h"

#include <gtest/gtest.h>

namespace sandflow {
namespace {

TEST(ChunkTurns, EveryChunkHasItsTurnOnce)
{
    for (std::size_t chunks = 0; chunks < 300; ++chunks) {
        const ChunkTurns turns(chunks);
        ASSERT_EQ(turns.begin(0), 0u);
        ASSERT_EQ(turns.begin(turns.count()), chunks);
        for (std::int64_t t = 0; t < turns.count(); ++t) {
            ASSERT_LT(turns.begin(t), turns.begin(t + 1)) << chunks << " chunks, turn " << t;
        }
    }
}

TEST(ChunkTurns, TheLastQuarterGoesOneByOne)
{
    const ChunkTurns few(5), many(106);
    EXPECT_EQ(few.count(), 5) << "with few chunks every thread gets one";
    EXPECT_EQ(many.begin(1), 4u);
    EXPECT_EQ(many.count(), 19 + 30);
    EXPECT_EQ(many.begin(many.count()) - many.begin(many.count() - 1), 1u);
}

}  // namespace
}  // namespace sandflow
