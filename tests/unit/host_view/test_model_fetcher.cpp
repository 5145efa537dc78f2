// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// A viewer takes a model's pieces from unknown servers: forged data are never shown.

#include "host_tools/spm_view/model_fetcher.hpp"
#include "tests/unit/transport/dds_rig.hpp"
#include "tests/unit/transport/stranger.hpp"
#include "tests/unit/transport/tiny_model.hpp"
#include "transport/content_hash.hpp"
#include "transport/dds/dds_server.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace tactus::view
{
namespace
{

using dds::Domain;
using test::eventually;
using test::Forgery;
using test::make_tiny_model;
using test::Stranger;
using test::TinyModel;

constexpr ContentKey kIndexPage{ContentKind::index_page, 0};
constexpr ContentKey kFirstChunk{ContentKind::chunk, 0};

struct ModelFetcherTest : ::testing::Test
{
    void SetUp() override
    {
        test::isolate_domains();
        viewer_.emplace(Domain::join(3, dds::Party::both).value());
        shelf_ = std::move(ModelShelf::open({})).value();
        sut_ = std::move(ModelFetcher::create(*viewer_, *shelf_, lines_.log())).value();
        stranger_ = std::make_unique<Stranger>(1, model_);
        sut_->look_for(hash_);
    }

    bool stepped_until(const std::function<bool()>& is_so)
    {
        return eventually(
            [&]
            {
                sut_->step();
                if (stranger_)
                {
                    stranger_->step();
                }
                if (host_)
                {
                    host_->step();
                }
                return is_so();
            });
    }

    /// Result of a browser's request, while all participants run.
    std::optional<Refusal> bring(ContentKey key)
    {
        const auto model = shelf_->find(hash_);
        std::optional<Refusal> refusal;
        std::atomic<bool> is_done{false};
        std::thread asks(
            [&]
            {
                refusal = model->bring(std::span(&key, 1));
                is_done = true;
            });
        EXPECT_TRUE(stepped_until([&] { return is_done.load(); }));
        asks.join();
        return refusal;
    }

    std::vector<std::byte> read(ContentKey key)
    {
        std::vector<std::byte> bytes;
        return shelf_->find(hash_)->read(key, bytes) ? bytes : std::vector<std::byte>{};
    }

    const TinyModel model_ = make_tiny_model({});
    const ContentHash hash_ = model_hash(model_.header);
    test::Lines lines_;
    test::TemporaryFolder folder_;
    std::optional<Domain> viewer_;
    std::unique_ptr<ModelShelf> shelf_;
    std::unique_ptr<ModelFetcher> sut_;
    std::unique_ptr<Stranger> stranger_;
    std::unique_ptr<dds::DdsServer> host_;
};

TEST_F(ModelFetcherTest, takes_no_forged_piece_and_the_true_ones_from_who_comes_next)
{
    ASSERT_TRUE(stepped_until([&] { return shelf_->has(hash_); })) << lines_.text();
    for (const Forgery how :
         {Forgery::another_byte, Forgery::cut_short, Forgery::longer, Forgery::empty})
    {
        stranger_->forge(ContentKind::index_page, how);
        EXPECT_TRUE(bring(kIndexPage).has_value()) << static_cast<int>(how);
        EXPECT_TRUE(read(kIndexPage).empty());
    }
    EXPECT_GE(stranger_->sent(ContentKind::index_page), 4);
    EXPECT_EQ(stranger_->sent(ContentKind::chunk), 0);

    stranger_->forge(ContentKind::index_page, Forgery::none);
    for (const Forgery how :
         {Forgery::another_byte, Forgery::cut_short, Forgery::longer, Forgery::empty})
    {
        stranger_->forge(ContentKind::chunk, how);
        EXPECT_TRUE(bring(kFirstChunk).has_value()) << static_cast<int>(how);
        EXPECT_TRUE(read(kFirstChunk).empty());
    }
    EXPECT_GE(stranger_->sent(ContentKind::chunk), 4);
    EXPECT_TRUE(std::ranges::equal(read(kIndexPage), model_.piece(kIndexPage)));

    stranger_.reset();
    std::vector<dds::PublishedModel> models;
    models.push_back({"tiny", ModelStore::open(folder_.write("tiny.spm", model_.file)).value()});
    host_ = std::move(dds::DdsServer::create(2, std::move(models), {})).value();
    ASSERT_TRUE(stepped_until([&] { return lines_.has("is served again"); })) << lines_.text();
    for (std::uint32_t chunk = 0; chunk < model_.chunks.size(); ++chunk)
    {
        const ContentKey key{ContentKind::chunk, chunk};
        const auto refusal = bring(key);
        EXPECT_FALSE(refusal.has_value()) << refusal->text;
        EXPECT_TRUE(std::ranges::equal(read(key), model_.piece(key))) << chunk;
    }
}

TEST_F(ModelFetcherTest, asks_a_server_no_more_whose_header_or_base_mesh_is_forged)
{
    for (const ContentKind kind : {ContentKind::header, ContentKind::base})
    {
        sut_.reset(); // Both end: a new one must not have heard of the server.
        stranger_.reset();
        shelf_ = std::move(ModelShelf::open({})).value();
        sut_ = std::move(ModelFetcher::create(*viewer_, *shelf_, lines_.log())).value();
        stranger_ = std::make_unique<Stranger>(1, model_);
        stranger_->forge(kind, Forgery::another_byte);
        sut_->look_for(hash_);
        const std::string before = lines_.text();
        ASSERT_TRUE(stepped_until([&] { return lines_.text() != before; })) << before;
        EXPECT_NE(lines_.text().find("model 'tiny'", before.size()), std::string::npos);
        const int sent = stranger_->sent(kind);
        EXPECT_GE(sent, 1);
        for (int i = 0; i < 200; ++i)
        {
            ASSERT_TRUE(stepped_until([] { return true; }));
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        EXPECT_FALSE(shelf_->has(hash_));
        EXPECT_LE(stranger_->sent(kind), sent + 1) << "it is asked again";
    }
}

} // namespace
} // namespace tactus::view
