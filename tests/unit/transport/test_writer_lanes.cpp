// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/unit/transport/dds_rig.hpp"
#include "tests/unit/transport/tiny_model.hpp"
#include "transport/dds/piece_frame.hpp"
#include "transport/dds/subscription.hpp"
#include "transport/dds/take.hpp"
#include "transport/dds/writer_lanes.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <set>

#include "tactus.h"

namespace tactus::dds
{

namespace
{

using test::eventually;

class Lanes : public ::testing::Test
{
protected:
    static constexpr const char* kPartition = "lanes";

    void SetUp() override
    {
        test::isolate_domains();
        host_.emplace(Domain::join(1).value());
        client_.emplace(Domain::join(2).value());
    }
    Endpoint reader(const std::string& partition)
    {
        return make_reader(*client_, Topic::chunks, {&partition, 1}).value();
    }
    /// What has come, by the count in the sample and who wrote it.
    void take_from(const Endpoint& reader)
    {
        take_each<tactus_v1_Pieces>(
            reader.handle, 100,
            [this](const tactus_v1_Pieces& sample, const dds_sample_info_t& info)
            {
                if (info.valid_data)
                {
                    counts_.insert(sample.sent);
                    writers_.insert(info.publication_handle);
                }
            });
    }

    std::optional<Domain> host_;
    std::optional<Domain> client_;
    std::set<std::uint64_t> counts_;
    std::set<dds_instance_handle_t> writers_;
};

TEST_F(Lanes, without_a_reader_are_not_matched_and_write_to_nobody)
{
    auto sut = WriterLanes::create(*host_, Topic::chunks, kPartition).value();
    tactus_v1_Pieces sample = {};

    EXPECT_FALSE(sut.is_matched());
    EXPECT_TRUE(sut.write(&sample));
}

TEST_F(Lanes, take_turns_and_everything_comes)
{
    constexpr std::uint64_t kSamples = 40;
    auto sut = WriterLanes::create(*host_, Topic::chunks, kPartition).value();
    const Endpoint in = reader(kPartition);
    const auto publishers = [&]
    {
        dds_subscription_matched_status_t status = {};
        dds_get_subscription_matched_status(in.handle, &status);
        return status.current_count;
    };
    ASSERT_TRUE(
        eventually([&] { return publishers() == WriterLanes::kLanes && sut.is_matched(); }));
    for (std::uint64_t i = 1; i <= kSamples; ++i)
    {
        tactus_v1_Pieces sample = {};
        sample.sent = i;
        ASSERT_TRUE(sut.write(&sample));
    }
    EXPECT_TRUE(eventually(
        [&]
        {
            take_from(in);
            return counts_.size() == kSamples;
        }));
    // A writer's own side of a match may come a moment later, so not all need to have had a turn.
    EXPECT_GT(writers_.size(), 1U);
}

TEST_F(Lanes, an_older_request_that_comes_late_takes_no_credit_back)
{
    const test::TemporaryFolder folder;
    const test::TinyModel model = test::make_tiny_model({.records = 64});
    const ModelStore store = ModelStore::open(folder.write("model.spm", model.file)).value();
    const ControllerId controller{1, 2, 3};
    auto sut = Subscription::create(*host_, store, controller, "controller", 0).value();
    sut.wish({ContentKind::chunk, 0}, 1);
    EXPECT_FALSE(sut.has_work()); // Nothing is granted yet.

    sut.set_credit({0, 128, 0});
    EXPECT_TRUE(sut.has_work());
    sut.set_credit({0, 0, 0});
    EXPECT_TRUE(sut.has_work());
}

} // namespace

} // namespace tactus::dds
