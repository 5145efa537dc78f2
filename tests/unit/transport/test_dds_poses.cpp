// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/math/infinity.hpp"
#include "tests/unit/transport/dds_rig.hpp"
#include "tests/unit/transport/tiny_model.hpp"
#include "transport/dds/dds_host.hpp"
#include "transport/dds/poses.hpp"

#include <dds/dds.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "tactus.h"

namespace tactus::dds
{
namespace
{

using test::eventually;
using test::make_tiny_model;
using test::TemporaryFolder;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// A quarter turn about z at some place.
Pose some_pose()
{
    return {{0.0, 0.0, std::sqrt(0.5), std::sqrt(0.5)}, {0.25, -1.5, 3.0}, 2.0};
}

/// A host of one model, and a controller that has found it; each in a domain of its own.
class DdsPoses : public ::testing::Test
{
protected:
    static constexpr std::uint32_t kHostDomain = 1;
    static constexpr std::uint32_t kOtherHostDomain = 2;
    static constexpr std::uint32_t kClientDomain = 3;

    void SetUp() override
    {
        test::isolate_domains();
        host_ = make_host(kHostDomain);
        client_.emplace(Domain::join(kClientDomain).value());
        catalogue_.emplace(Catalogue::create(*client_, {}).value());
        const DdsHost& host = *host_;
        identity_ = {"tiny", host.models()[0].store.hash(), host.models()[0].store.revision()};
        ASSERT_TRUE(eventually(
            [&]
            {
                catalogue_->refresh();
                return catalogue_->find({identity_.name, identity_.hash}) != nullptr;
            }));
        reader_ = make_reader_of({identity_});
    }

    std::unique_ptr<DdsHost> make_host(std::uint32_t domain)
    {
        const auto path =
            folder_.write(("tiny" + std::to_string(domain)).c_str(), make_tiny_model({}).file);
        std::vector<PublishedModel> models;
        models.push_back({"tiny", ModelStore::open(path).value()});
        auto host = DdsHost::create(domain, std::move(models), [](const std::string&) {});
        EXPECT_TRUE(host) << host.error().text;
        return std::move(host).value();
    }
    std::unique_ptr<PoseReader> make_reader_of(std::vector<ModelIdentity> objects)
    {
        return std::move(PoseReader::create(*client_, *catalogue_, std::move(objects))).value();
    }
    std::unique_ptr<PosePublisher> make_publisher(const DdsHost& host)
    {
        return std::move(PosePublisher::create(host.domain(), host.epoch(), {identity_})).value();
    }

    void poll()
    {
        reader_->poll([this](const PoseNews& news) { news_.push_back(news); });
    }
    [[nodiscard]] const PoseCounts& counts() const { return reader_->counts()[0]; }
    [[nodiscard]] std::uint64_t refused(PoseRefusal refusal) const
    {
        return counts().refused.at(static_cast<std::size_t>(refusal));
    }

    /// A sample that would be accepted, as any program could write it.
    tactus_v1_ObjectPose good_sample(std::uint64_t serial)
    {
        tactus_v1_ObjectPose sample = {};
        sample.host_epoch = host_->epoch();
        identity_.name.copy(static_cast<char*>(sample.name), kMaxNameBytes);
        sample.protocol_version = kProtocolVersion;
        std::memcpy(sample.model_hash, identity_.hash.data(), identity_.hash.size());
        sample.revision = identity_.revision;
        sample.serial = serial;
        sample.rotation[3] = 1.0;
        sample.scale = 1.0;
        return sample;
    }
    Endpoint raw_writer()
    {
        auto writer = make_writer(host_->domain(), Topic::poses, model_partition(identity_.hash));
        EXPECT_TRUE(eventually([&] { return is_matched(writer.value()); }));
        return std::move(writer).value();
    }
    /// Writes until the reader has counted it: best effort promises nothing.
    void write_until_counted(const Endpoint& writer, tactus_v1_ObjectPose sample)
    {
        const std::uint64_t before = counts().accepted + counts().refused_in_all();
        EXPECT_TRUE(eventually(
            [&]
            {
                EXPECT_EQ(dds_write(writer.handle, &sample), DDS_RETCODE_OK);
                for (int i = 0; i < 50 && counts().accepted + counts().refused_in_all() == before;
                     ++i)
                {
                    poll();
                    std::this_thread::sleep_for(std::chrono::milliseconds(1));
                }
                return counts().accepted + counts().refused_in_all() > before;
            }));
    }

    TemporaryFolder folder_;
    std::unique_ptr<DdsHost> host_;
    std::optional<Domain> client_;
    std::optional<Catalogue> catalogue_;
    ModelIdentity identity_;
    std::unique_ptr<PoseReader> reader_;
    std::vector<PoseNews> news_;
};

TEST_F(DdsPoses, come_as_they_were_sent)
{
    const auto sut = make_publisher(*host_);
    EXPECT_TRUE(eventually(
        [&]
        {
            EXPECT_TRUE(sut->move(0, some_pose()));
            poll();
            return !news_.empty();
        }));
    const PoseNews& news = news_.back();
    EXPECT_EQ(news.object, 0U);
    EXPECT_EQ(news.pose.translation_m, some_pose().translation_m);
    EXPECT_EQ(news.pose.scale, some_pose().scale);
    for (std::size_t i = 0; i < 4; ++i)
    {
        EXPECT_NEAR(news.pose.rotation.at(i), some_pose().rotation.at(i), 1e-15);
    }
    EXPECT_GT(news.host_time_ns, 0);
    EXPECT_EQ(counts().refused_in_all(), 0U);
}

TEST_F(DdsPoses, a_late_joiner_learns_where_an_object_rests)
{
    const auto sut = make_publisher(*host_);
    ASSERT_TRUE(sut->move(0, some_pose()));
    for (int i = 0; i < 20; ++i) // Long gone when the reader comes.
    {
        poll();
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    news_.clear();
    reader_ = make_reader_of({identity_});
    EXPECT_TRUE(eventually(
        [&]
        {
            sut->repeat();
            poll();
            return !news_.empty();
        }));
    EXPECT_EQ(news_.front().pose.translation_m, some_pose().translation_m);
}

TEST_F(DdsPoses, an_object_that_was_never_moved_is_not_spoken_of)
{
    const Endpoint matched = raw_writer();
    const auto sut = make_publisher(*host_);
    for (int i = 0; i < 100; ++i)
    {
        sut->repeat();
        poll();
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    EXPECT_EQ(counts().accepted, 0U);
    write_until_counted(matched, good_sample(1)); // The road was there.
    EXPECT_EQ(counts().accepted, 1U);
}

TEST_F(DdsPoses, no_pose_leaves_the_publisher)
{
    const auto sut = make_publisher(*host_);
    Pose pose = some_pose();
    pose.scale = kNan;
    EXPECT_EQ(sut->move(0, pose).error(), PoseRefusal::not_finite);
    pose = some_pose();
    pose.rotation[0] = 1.0;
    EXPECT_EQ(sut->move(0, pose).error(), PoseRefusal::rotation);
    EXPECT_TRUE(sut->move(0, some_pose()));
}

TEST_F(DdsPoses, each_fault_is_refused_under_its_name)
{
    struct Fault
    {
        PoseRefusal refusal;
        std::function<void(tactus_v1_ObjectPose&)> make;
    };
    using Sample = tactus_v1_ObjectPose;
    const std::vector<Fault> faults{
        {PoseRefusal::version, [](Sample& s) { s.protocol_version = kProtocolVersion + 1; }},
        {PoseRefusal::host, [](Sample& s) { s.host_epoch ^= 1U; }},
        {PoseRefusal::model, [](Sample& s) { s.model_hash[15] ^= 1U; }},
        {PoseRefusal::model, [](Sample& s) { s.revision += 1; }},
        {PoseRefusal::not_finite, [](Sample& s) { s.rotation[0] = kNan; }},
        {PoseRefusal::not_finite, [](Sample& s) { s.rotation[3] = kInfinity; }},
        {PoseRefusal::not_finite, [](Sample& s) { s.translation_m[1] = -kInfinity; }},
        {PoseRefusal::not_finite, [](Sample& s) { s.translation_m[2] = kNan; }},
        {PoseRefusal::not_finite, [](Sample& s) { s.scale = kNan; }},
        {PoseRefusal::rotation, [](Sample& s) { s.rotation[3] = 0.0; }},
        {PoseRefusal::rotation, [](Sample& s) { s.rotation[3] = 1.0011; }},
        {PoseRefusal::rotation, [](Sample& s) { s.rotation[3] = 0.9989; }},
        {PoseRefusal::rotation, [](Sample& s) { s.rotation[0] = 1e300; }},
        {PoseRefusal::translation, [](Sample& s) { s.translation_m[0] = 10'000.1; }},
        {PoseRefusal::translation, [](Sample& s) { s.translation_m[2] = -10'000.1; }},
        {PoseRefusal::scale, [](Sample& s) { s.scale = 0.0; }},
        {PoseRefusal::scale, [](Sample& s) { s.scale = -1.0; }},
        {PoseRefusal::scale, [](Sample& s) { s.scale = 1'000.1; }},
        {PoseRefusal::not_newer, [](Sample& s) { s.serial = 1; }},
    };
    const Endpoint writer = raw_writer();
    write_until_counted(writer, good_sample(1));
    ASSERT_EQ(counts().accepted, 1U);
    for (std::size_t i = 0; i < faults.size(); ++i)
    {
        tactus_v1_ObjectPose sample = good_sample(100 + i);
        faults[i].make(sample);
        const std::uint64_t before = refused(faults[i].refusal);
        write_until_counted(writer, sample);
        EXPECT_GT(refused(faults[i].refusal), before) << i;
        EXPECT_EQ(counts().accepted, 1U) << i;
    }
    EXPECT_EQ(news_.size(), 1U);
    write_until_counted(writer, good_sample(2)); // Nothing of what was refused is remembered.
    EXPECT_EQ(counts().accepted, 2U);
}

TEST_F(DdsPoses, the_edges_of_what_is_allowed_are_taken)
{
    const Endpoint writer = raw_writer();
    auto sample = good_sample(1);
    sample.rotation[3] = 1.0 + 0.99 * kPoseUnitTolerance;
    sample.translation_m[0] = -1e4;
    sample.scale = 1e3;
    write_until_counted(writer, sample);
    ASSERT_EQ(news_.size(), 1U);
    EXPECT_EQ(news_[0].pose.rotation[3], 1.0);
    EXPECT_EQ(news_[0].pose.translation_m[0], -1e4);
    EXPECT_EQ(news_[0].pose.scale, 1e3);
}

TEST_F(DdsPoses, an_older_one_and_a_repeated_one_are_passed_over)
{
    const Endpoint writer = raw_writer();
    write_until_counted(writer, good_sample(5));
    write_until_counted(writer, good_sample(4));
    EXPECT_EQ(counts().accepted, 1U);
    EXPECT_GE(refused(PoseRefusal::not_newer), 1U);
    const std::uint64_t before = refused(PoseRefusal::not_newer);
    write_until_counted(writer, good_sample(5));
    EXPECT_EQ(counts().accepted, 1U);
    EXPECT_GT(refused(PoseRefusal::not_newer), before);
    write_until_counted(writer, good_sample(std::numeric_limits<std::uint64_t>::max()));
    EXPECT_EQ(counts().accepted, 2U);
}

TEST_F(DdsPoses, a_publisher_that_starts_again_under_its_epoch_is_followed_on)
{
    for (int i = 0; i < 2; ++i)
    {
        const auto sut = make_publisher(*host_);
        const std::uint64_t before = counts().accepted;
        EXPECT_TRUE(eventually(
            [&]
            {
                EXPECT_TRUE(sut->move(0, some_pose()));
                poll();
                return counts().accepted > before;
            }));
    }
    EXPECT_EQ(counts().refused_in_all(), 0U);
}

TEST_F(DdsPoses, where_two_hosts_serve_the_model_one_moves_it_until_it_goes)
{
    const auto other = make_host(kOtherHostDomain);
    const auto second = make_publisher(*other);
    EXPECT_TRUE(eventually(
        [&]
        {
            catalogue_->refresh();
            EXPECT_TRUE(second->move(0, some_pose()));
            poll();
            return refused(PoseRefusal::host) > 0;
        }));
    EXPECT_EQ(counts().accepted, 0U);
    host_.reset();
    EXPECT_TRUE(eventually(
        [&]
        {
            catalogue_->refresh();
            EXPECT_TRUE(second->move(0, some_pose()));
            poll();
            return counts().accepted > 0;
        }));
}

TEST_F(DdsPoses, a_model_that_is_shown_twice_moves_twice_and_another_name_moves_nothing)
{
    reader_ = make_reader_of({identity_, {"other", identity_.hash, identity_.revision}, identity_});
    const Endpoint writer = raw_writer();
    write_until_counted(writer, good_sample(1));
    ASSERT_EQ(news_.size(), 2U);
    EXPECT_EQ(news_[0].object, 0U);
    EXPECT_EQ(news_[1].object, 2U);
    EXPECT_EQ(reader_->counts()[1].accepted, 0U);
}

/// Whatever stands in a sample: only a pose passes, and a flood leaves one of each object.
TEST_F(DdsPoses, noise_never_passes_for_a_pose)
{
    constexpr std::uint64_t kSeed = 20'261'122;
    std::mt19937_64 random(kSeed);
    const Endpoint writer = raw_writer();
    for (int i = 0; i < 5'000; ++i)
    {
        tactus_v1_ObjectPose sample = good_sample(static_cast<std::uint64_t>(i) + 1);
        for (double* number : {&sample.rotation[0], &sample.rotation[1], &sample.rotation[2],
                               &sample.rotation[3], &sample.translation_m[0], &sample.scale})
        {
            const std::uint64_t bits = random();
            std::memcpy(number, &bits, sizeof(bits));
        }
        dds_write(writer.handle, &sample);
        poll();
    }
    write_until_counted(writer, good_sample(10'000));
    for (const PoseNews& news : news_)
    {
        EXPECT_TRUE(checked_pose(news.pose)) << "seed " << kSeed;
    }
    EXPECT_EQ(counts().accepted, news_.size());
    EXPECT_GT(counts().refused_in_all(), 0U);
}

TEST_F(DdsPoses, a_flood_between_two_polls_leaves_the_newest)
{
    const Endpoint writer = raw_writer();
    write_until_counted(writer, good_sample(1));
    const std::uint64_t before = counts().accepted;
    for (std::uint64_t serial = 2; serial <= 10'000; ++serial)
    {
        auto sample = good_sample(serial);
        dds_write(writer.handle, &sample);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    poll();
    EXPECT_LE(counts().accepted, before + 1);
}

} // namespace
} // namespace tactus::dds
