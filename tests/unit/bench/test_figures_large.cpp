// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Splits and bytes on 1.1 M faces.

#include "tests/bench/first_contact.hpp"
#include "tests/unit/bench/opened_model.hpp"

#include <gtest/gtest.h>

#include <cstdio>

namespace tactus::bench
{
namespace
{

void print(const char* name, const ContactSpread& spread)
{
    std::printf("[ figures  ] %s: p50 %.0f, p90 %.0f, max %.0f\n", name, spread.p50, spread.p90,
                spread.max);
}

TEST(LargeModel, takes_few_splits_and_bytes_until_an_answer_is_exact)
{
    const OpenedModel model(1'100'000, 500);
    const double radius_m = 0.01 * model.model.diagonal_m;
    const test::FaceTree tree(model.model.faces);
    const ExactSplits exact =
        measure_exact_splits(model.decoded, model.model.faces, tree, radius_m, 500, 1);
    print("splits", exact.splits);
    EXPECT_LE(exact.distance_error_max_m, 1e-15 * model.model.diagonal_m);
    EXPECT_LE(exact.splits.p50, 250.0);

    const FirstContactFigures contact =
        measure_first_contact(model.store, model.decoded, model.model.faces, radius_m, 500, 1);
    print("bytes without hashes", contact.all_bytes);
    print("bytes", contact.all_hashed_bytes);
    EXPECT_EQ(contact.missed_chunks, 0U);
    EXPECT_LE(contact.all_bytes.p50, 80e3);
    EXPECT_LE(contact.all_hashed_bytes.p50, 110e3);
    EXPECT_LE(model.store.header().fields().base_faces, 500U);
}

} // namespace
} // namespace tactus::bench
