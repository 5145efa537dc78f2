// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/first_contact.hpp"
#include "tests/unit/bench/opened_model.hpp"

#include <gtest/gtest.h>

namespace tactus::bench
{

namespace
{

class FirstContact : public testing::Test
{
protected:
    [[nodiscard]] FirstContactFigures measured(double radius_diag, std::uint32_t contacts)
    {
        return measure_first_contact(model_.store, model_.decoded, model_.model.faces,
                                     radius_diag * model_.model.diagonal_m, contacts, 1);
    }

    OpenedModel model_{20'000, 200};
};

TEST_F(FirstContact, with_the_whole_model_takes_the_whole_file)
{
    const FirstContactFigures sut = measured(2.0, 3);
    const HeaderFields& fields = model_.store.header().fields();
    EXPECT_EQ(sut.all_hashed_bytes.p50, static_cast<double>(fields.file_bytes));
    EXPECT_EQ(sut.chunks.max, model_.store.header().counts().chunks());
    EXPECT_EQ(sut.splits.p50, fields.records);
    EXPECT_EQ(sut.needed_bytes.max, sut.chunk_bytes.max);
    EXPECT_EQ(sut.missed_chunks, 0U);
    // The hashes are one a chunk, one an index page, the base mesh's and 32 bytes of root.
    const ModelCounts counts = model_.store.header().counts();
    EXPECT_EQ(sut.all_hashed_bytes.max - sut.all_bytes.max,
              16 * (counts.chunks() + counts.index_pages() + 1) + 32);
}

TEST_F(FirstContact, with_a_small_tool_takes_less_and_never_lacks_a_chunk)
{
    const FirstContactFigures small = measured(0.001, 100);
    const FirstContactFigures large = measured(0.05, 100);
    EXPECT_EQ(small.missed_chunks, 0U);
    EXPECT_EQ(large.missed_chunks, 0U);
    EXPECT_LT(small.all_bytes.p50, large.all_bytes.p50);
    EXPECT_LT(small.splits.p50, large.splits.p50);
    EXPECT_LE(small.needed_bytes.p50, small.chunk_bytes.p50);
    EXPECT_LT(large.all_bytes.max, measured(2.0, 1).all_bytes.max);
    EXPECT_LE(small.all_bytes.p50, small.all_bytes.p90);
    EXPECT_LE(small.all_bytes.p90, small.all_bytes.max);
}

} // namespace

} // namespace tactus::bench
