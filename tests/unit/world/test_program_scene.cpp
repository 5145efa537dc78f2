// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/scene/program_scene.hpp"
#include "tests/shared/test_model.hpp"
#include "transport/store/store_link.hpp"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace tactus::hrtc::test
{
namespace
{

/// One model, one object and room for two.
struct ProgramSceneTest : ::testing::Test
{
    ProgramSceneTest()
    {
        models_.push_back(
            std::move(serve_from_file(tactus::test::small_model(0).path, "part", {}).value()));
        sut_.emplace(SceneParts{models_, objects_, {}, {0}, 2}, poses_);
        sut_->connect(mailbox_);
    }

    /// Changes that the frame would get after a round.
    std::vector<SceneChange> changes()
    {
        now_ = now_ + milliseconds(1);
        sut_->step(now_);
        const auto changes = mailbox_.refresh(now_);
        return {changes.begin(), changes.end()};
    }

    std::vector<ServedModel> models_;
    std::vector<ObjectSpec> objects_{{ModelId{0}}};
    std::vector<ObjectPose> poses_{1};
    SceneMailbox mailbox_{poses_, 2, milliseconds(100)};
    std::optional<ProgramScene> sut_;
    MonotonicTime now_{1'000'000'000};
};

TEST_F(ProgramSceneTest, an_object_comes_moves_feels_and_goes_in_this_order)
{
    EXPECT_TRUE(changes().empty());
    const auto second = sut_->try_add({ModelId{0}}, {});
    ASSERT_TRUE(second);
    EXPECT_EQ(second->number, 1U);
    EXPECT_FALSE(sut_->try_add({ModelId{0}}, {})) << "both numbers are in use";
    auto told = changes();
    ASSERT_EQ(told.size(), 1U);
    EXPECT_EQ(told[0].kind, SceneChangeKind::object_comes);
    EXPECT_EQ(told[0].generation, 1U);

    Similarity place;
    place.translation_m = Vec3(0.1, 0.0, 0.0);
    EXPECT_TRUE(sut_->try_move(*second, place));
    EXPECT_TRUE(sut_->try_set_material(*second, {.static_friction = 1.0}));
    told = changes();
    ASSERT_EQ(told.size(), 2U);
    EXPECT_EQ(told[0].kind, SceneChangeKind::object_feels);
    EXPECT_EQ(told[1].kind, SceneChangeKind::object_moves);

    EXPECT_TRUE(sut_->try_remove(*second));
    EXPECT_FALSE(sut_->try_move(*second, place));
    EXPECT_FALSE(sut_->try_set_material(*second, {}));
    EXPECT_FALSE(sut_->try_remove(*second));
    EXPECT_FALSE(sut_->place_of(*second));
    told = changes();
    ASSERT_EQ(told.size(), 1U);
    EXPECT_EQ(told[0].kind, SceneChangeKind::object_goes);
}

TEST_F(ProgramSceneTest, a_number_is_used_again_with_another_generation)
{
    EXPECT_TRUE(sut_->try_remove({0, 0}));
    const auto again = sut_->try_add({ModelId{0}}, {}); // Before a round has told of the removal.
    ASSERT_TRUE(again);
    EXPECT_EQ(again->number, 0U);
    EXPECT_EQ(again->generation, 1U);
    const auto told = changes();
    ASSERT_EQ(told.size(), 2U);
    EXPECT_EQ(told[0].kind, SceneChangeKind::object_goes);
    EXPECT_EQ(told[0].generation, 0U);
    EXPECT_EQ(told[1].kind, SceneChangeKind::object_comes);
    EXPECT_FALSE(sut_->try_move({0, 0}, {})) << "a handle of the removed object";
    EXPECT_TRUE(sut_->try_move(*again, {}));
}

TEST_F(ProgramSceneTest, an_object_of_a_program_never_grows_old)
{
    EXPECT_TRUE(sut_->try_move({0, 0}, {}));
    static_cast<void>(changes());
    now_ = now_ + milliseconds(10'000);
    for (const SceneChange& change : changes())
    {
        EXPECT_EQ(change.pose.arrival_ns, 0);
    }
    EXPECT_EQ(mailbox_.uses()[0].old_frames, 0U);
}

} // namespace
} // namespace tactus::hrtc::test
