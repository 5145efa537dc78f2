// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/loop/edit_mailbox.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <thread>

namespace tactus
{
namespace
{

/// Edit of as many faces as its number says, each with the number in it.
EditContent edit_of(std::uint32_t number)
{
    EditContent edit;
    edit.revision = number;
    for (std::uint32_t i = 0; i < number % (kMaxEditFaces + 1); ++i)
    {
        edit.removed.push_back(FaceId{number + i});
        edit.added.push_back({number, i, {}});
    }
    edit.removed_m.add(Vec3f{static_cast<float>(number), 0.0F, 0.0F});
    return edit;
}

void expect_is(const SurfaceEdit& edit, std::uint32_t number)
{
    const EditContent expected = edit_of(number);
    ASSERT_EQ(edit.model, ModelId{number % 7});
    ASSERT_EQ(edit.revision, number);
    ASSERT_EQ(edit.removed_m, expected.removed_m);
    ASSERT_TRUE(std::ranges::equal(edit.removed, expected.removed));
    ASSERT_TRUE(std::ranges::equal(edit.added, expected.added));
}

bool try_put(EditMailbox& sut, std::uint32_t number)
{
    return sut.try_put(ModelId{number % 7}, edit_of(number));
}

/// Models after a frame that made all edits up to this number.
std::array<ModelOutput, 7> models_after(std::uint32_t number)
{
    std::array<ModelOutput, 7> models;
    for (ModelOutput& model : models)
    {
        model.edit_revision = number;
    }
    return models;
}

TEST(EditMailbox, is_empty_at_first)
{
    EditMailbox sut;
    EXPECT_TRUE(sut.edits().empty());
    sut.done({});
    EXPECT_TRUE(sut.edits().empty());
    EXPECT_FALSE(sut.take_refused_model());
}

TEST(EditMailbox, refuses_an_edit_too_many_and_has_room_once_a_frame_is_done)
{
    EditMailbox sut;
    std::uint32_t next = 1;
    while (next <= EditMailbox::kEdits)
    {
        ASSERT_TRUE(try_put(sut, next++));
    }
    EXPECT_FALSE(try_put(sut, next));
    const auto edits = sut.edits();
    ASSERT_EQ(edits.size(), EditMailbox::kEditsPerFrame);
    EXPECT_FALSE(try_put(sut, next)); // The frame still reads them.
    expect_is(edits[0], 1);
    sut.done(models_after(1));
    EXPECT_EQ(sut.taken(), EditMailbox::kEditsPerFrame);
    for (std::uint32_t i = 0; i < EditMailbox::kEditsPerFrame; ++i)
    {
        EXPECT_TRUE(try_put(sut, next++));
    }
    EXPECT_FALSE(try_put(sut, next));
    expect_is(sut.edits()[0], 1 + EditMailbox::kEditsPerFrame);
}

TEST(EditMailbox, edits_that_are_not_done_are_shown_again)
{
    EditMailbox sut;
    ASSERT_TRUE(try_put(sut, 5));
    expect_is(sut.edits()[0], 5);
    expect_is(sut.edits()[0], 5);
    sut.done(models_after(6));
    EXPECT_TRUE(sut.edits().empty());
    EXPECT_FALSE(sut.take_refused_model());
}

TEST(EditMailbox, tells_once_the_model_whose_edit_a_frame_refused)
{
    EditMailbox sut;
    ASSERT_TRUE(try_put(sut, 5));
    ASSERT_TRUE(try_put(sut, 6));
    ASSERT_EQ(sut.edits().size(), 1U);
    std::array<ModelOutput, 7> models = models_after(5);
    models[5].edit_revision = 4;
    sut.done(models);
    EXPECT_EQ(sut.take_refused_model(), ModelId{5});
    EXPECT_FALSE(sut.take_refused_model());
    ASSERT_EQ(sut.edits().size(), 1U); // The frame does not have the edit's model.
    sut.done(std::span(models).first(3));
    EXPECT_EQ(sut.take_refused_model(), ModelId{6});
}

TEST(EditMailbox, passes_all_edits_in_order_between_two_threads)
{
    constexpr std::uint32_t kAll = 3'000;
    EditMailbox sut;
    std::thread transport(
        [&]
        {
            for (std::uint32_t number = 1; number <= kAll;)
            {
                number += try_put(sut, number) ? 1U : 0U;
            }
        });
    std::uint32_t taken = 0;
    while (taken < kAll)
    {
        const auto edits = sut.edits();
        ASSERT_LE(edits.size(), EditMailbox::kEditsPerFrame);
        for (const SurfaceEdit& edit : edits)
        {
            expect_is(edit, ++taken);
        }
        sut.done(models_after(taken));
    }
    transport.join();
    EXPECT_FALSE(sut.take_refused_model());
    EXPECT_EQ(sut.taken(), kAll);
    EXPECT_TRUE(sut.edits().empty());
}

} // namespace
} // namespace tactus
