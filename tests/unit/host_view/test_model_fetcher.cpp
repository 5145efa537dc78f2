// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// A viewer takes a model's pieces from hosts that it doesn't know: what they forge is never shown.

#include "host_tools/spm_view/model_fetcher.hpp"
#include "tests/unit/transport/dds_rig.hpp"
#include "tests/unit/transport/tiny_model.hpp"
#include "transport/content_hash.hpp"
#include "transport/dds/dds_host.hpp"
#include "transport/dds/piece_frame.hpp"
#include "transport/dds/take.hpp"

#include <dds/dds.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tactus.h"

namespace tactus::view
{
namespace
{

using dds::Domain;
using test::eventually;
using test::make_tiny_model;
using test::TinyModel;

constexpr ContentKey kIndexPage{ContentKind::index_page, 0};
constexpr ContentKey kFirstChunk{ContentKind::chunk, 0};

/// What a stranger makes of a piece.
enum class Forgery
{
    none,
    another_byte,
    cut_short,
    longer,
    empty,
};

std::vector<std::byte> forged(std::span<const std::byte> piece, Forgery how)
{
    std::vector<std::byte> bytes(piece.begin(), piece.end());
    switch (how)
    {
    case Forgery::none:
        break;
    case Forgery::another_byte:
        bytes[bytes.size() / 2] ^= std::byte{1};
        break;
    case Forgery::cut_short:
        bytes.pop_back();
        break;
    case Forgery::longer:
        bytes.push_back(std::byte{0});
        break;
    case Forgery::empty:
        bytes.clear();
        break;
    }
    return bytes;
}

/// A host of its own making: it says that it has the model, and answers with what it likes. Header
/// and base mesh are the true ones.
class Stranger
{
public:
    Stranger(std::uint32_t domain, const TinyModel& model)
        : model_(model)
        , domain_(Domain::join(domain).value())
        , epoch_(dds::host_epoch_of(domain_.participants().own()))
        , catalogue_(std::move(make_writer(domain_, dds::Topic::catalogue, "")).value())
        , wanted_(std::move(make_reader(domain_, dds::Topic::wanted, dds::kAnyPartition)).value())
    {
        announce();
    }

    /// From now on pieces of this kind are forged so.
    void forge(ContentKind kind, Forgery how) { forgeries_[kind] = how; }

    void step()
    {
        announce();
        dds::take_each<tactus_v4_Wanted>(
            wanted_.handle, 100,
            [this](const tactus_v4_Wanted& sample, const dds_sample_info_t& info)
            {
                if (info.valid_data && sample.host_epoch == epoch_)
                {
                    answer(sample);
                }
            });
    }

    [[nodiscard]] int sent(ContentKind kind) { return sent_by_kind_[kind]; }

private:
    void announce()
    {
        tactus_v4_CatalogueEntry entry = {};
        entry.host_epoch = epoch_;
        std::strcpy(static_cast<char*>(entry.name), "tiny");
        const ContentHash hash = model_hash(model_.header);
        std::memcpy(entry.model_hash, hash.data(), hash.size());
        entry.faces = 1;
        entry.header_bytes = static_cast<std::uint32_t>(model_.header.size());
        entry.base_bytes = static_cast<std::uint32_t>(model_.base.size());
        dds_write(catalogue_.handle, &entry);
    }

    void answer(const tactus_v4_Wanted& wanted)
    {
        dds::ControllerId id{};
        std::memcpy(id.data(), wanted.controller, id.size());
        if (!chunks_)
        {
            const std::string name(static_cast<const char*>(wanted.controller_name));
            chunks_ = std::move(make_writer(domain_, dds::Topic::chunks,
                                            dds::controller_partition(name, id)))
                          .value();
        }
        if (!is_matched(*chunks_))
        {
            return; // It will be asked for again.
        }
        for (std::uint32_t i = 0; i < wanted.pieces._length; ++i)
        {
            const tactus_v4_PieceName& name = wanted.pieces._buffer[i];
            send({static_cast<ContentKind>(name.kind), name.number});
        }
    }

    void send(ContentKey key)
    {
        const bool is_part = key.kind == ContentKind::header || key.kind == ContentKind::base;
        const std::span<const std::byte> true_bytes =
            is_part ? std::span(key.kind == ContentKind::header ? model_.header : model_.base)
                    : model_.piece(key);
        const std::vector<std::byte> bytes = forged(true_bytes, forgeries_[key.kind]);
        std::vector<std::byte> payload;
        dds::append_piece(
            payload,
            {model_hash(model_.header), 0, static_cast<std::uint32_t>(key.kind), key.number},
            bytes);
        tactus_v4_Pieces sample = {};
        sample.host_epoch = epoch_;
        sample.sent = ++sent_;
        const auto count = static_cast<std::uint32_t>(payload.size());
        sample.payload = {count, count, reinterpret_cast<std::uint8_t*>(payload.data()), false};
        dds_write(chunks_->handle, &sample);
        ++sent_by_kind_[key.kind];
    }

    const TinyModel& model_;
    Domain domain_;
    std::uint64_t epoch_;
    dds::Endpoint catalogue_;
    dds::Endpoint wanted_;
    std::optional<dds::Endpoint> chunks_;
    std::uint64_t sent_{0};
    std::map<ContentKind, Forgery> forgeries_;
    std::map<ContentKind, int> sent_by_kind_;
};

class ModelFetcherTest : public ::testing::Test
{
protected:
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

    /// What a request of the browser would get, while everybody goes on.
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
    std::unique_ptr<dds::DdsHost> host_;
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
    host_ = std::move(dds::DdsHost::create(2, std::move(models), {})).value();
    ASSERT_TRUE(stepped_until([&] { return lines_.has("is served again"); })) << lines_.text();
    for (std::uint32_t chunk = 0; chunk < model_.chunks.size(); ++chunk)
    {
        const ContentKey key{ContentKind::chunk, chunk};
        const auto refusal = bring(key);
        EXPECT_FALSE(refusal.has_value()) << refusal->text;
        EXPECT_TRUE(std::ranges::equal(read(key), model_.piece(key))) << chunk;
    }
}

TEST_F(ModelFetcherTest, asks_a_host_no_more_whose_header_or_base_mesh_is_forged)
{
    for (const ContentKind kind : {ContentKind::header, ContentKind::base})
    {
        sut_.reset(); // Both: a new one must hear nothing of the host before.
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
