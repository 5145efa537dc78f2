// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/unit/transport/tiny_model.hpp"
#include "transport/base/printable.hpp"
#include "transport/content_hash.hpp"
#include "transport/model_name.hpp"
#include "transport/store/model_store.hpp"
#include "transport/store/store_link.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace tactus
{
namespace
{

using test::make_tiny_model;
using test::TemporaryFolder;
using test::TinyModel;

std::string refusal_of(const std::filesystem::path& path)
{
    const auto store = ModelStore::open(path);
    return store ? "" : store.error().text;
}

/// Form of every refusal: one line that begins with the file's name.
void expect_one_clear_line(const std::string& text, const std::filesystem::path& path)
{
    EXPECT_EQ(text.rfind(path.string() + ": ", 0), 0U) << text;
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
    EXPECT_GT(text.size(), path.string().size() + 8) << text;
}

TEST(ModelStore, reads_every_piece_as_it_was_written)
{
    const TinyModel model = make_tiny_model({.records = 64 * 70 + 3});
    const TemporaryFolder folder;
    const auto opened = ModelStore::open(folder.write("a.spm", model.file));
    ASSERT_TRUE(opened) << opened.error().text;
    const ModelStore& sut = opened.value();
    ASSERT_EQ(model.index_pages.size(), 2U);
    std::vector<std::byte> bytes;
    const auto check = [&](ContentKey key)
    {
        ASSERT_TRUE(sut.read(key, bytes).has_value());
        EXPECT_TRUE(std::ranges::equal(bytes, model.piece(key))) << key.number;
        EXPECT_EQ(sut.coded_bytes(key), bytes.size());
    };
    check({ContentKind::base, 0});
    for (std::uint32_t page = 0; page < 2; ++page)
    {
        check({ContentKind::index_page, page});
    }
    for (std::uint32_t chunk = 0; chunk < model.chunks.size(); ++chunk)
    {
        check({ContentKind::chunk, chunk});
    }
    EXPECT_TRUE(std::ranges::equal(sut.header_bytes(), model.header));
    EXPECT_EQ(sut.hash(), content_hash(std::span(model.header).first(model.header.size() - 36)));
}

TEST(ModelStore, serves_a_model_without_records)
{
    const TemporaryFolder folder;
    const auto sut = ModelStore::open(folder.write("a.spm", make_tiny_model({.records = 0}).file));
    ASSERT_TRUE(sut) << sut.error().text;
    EXPECT_FALSE(sut.value().has({ContentKind::chunk, 0}));
    EXPECT_TRUE(sut.value().has({ContentKind::base, 0}));
}

TEST(ModelStore, refuses_a_piece_that_the_model_does_not_have)
{
    const TemporaryFolder folder;
    const auto sut = ModelStore::open(folder.write("a.spm", make_tiny_model({}).file));
    ASSERT_TRUE(sut);
    std::vector<std::byte> bytes;
    EXPECT_FALSE(sut.value().read({ContentKind::chunk, 4}, bytes));
    EXPECT_FALSE(sut.value().read({ContentKind::index_page, 1}, bytes));
    EXPECT_FALSE(sut.value().read({ContentKind::base, 1}, bytes));
    EXPECT_FALSE(sut.value().read({static_cast<ContentKind>(9), 0}, bytes));
}

TEST(ModelStore, says_what_is_wrong_with_files_that_are_no_model)
{
    const TemporaryFolder folder;
    const std::string png =
        "\x89PNG\r\n\x1a\n and much more text, longer than a header would be...";
    const auto foreign = folder.write("foreign.spm", std::as_bytes(std::span(png)));
    const auto empty = folder.write("empty.spm", "");
    EXPECT_NE(refusal_of(foreign).find("is not an SPM model"), std::string::npos);
    EXPECT_EQ(refusal_of(empty), empty.string() + ": is empty");
    EXPECT_NE(refusal_of(folder.path() / "none.spm").find("No such file"), std::string::npos);
    EXPECT_NE(refusal_of(folder.path()).find("is not a file"), std::string::npos);
    EXPECT_NE(refusal_of("/dev/null").find("is not a file"), std::string::npos);
}

TEST(ModelStore, names_the_chunk_when_the_file_is_cut_while_it_is_served)
{
    const TinyModel model = make_tiny_model({.records = 200});
    const TemporaryFolder folder;
    const auto path = folder.write("served.spm", model.file);
    const auto sut = ModelStore::open(path);
    ASSERT_TRUE(sut);
    std::filesystem::resize_file(path, model.file.size() - 10);
    std::vector<std::byte> bytes;
    EXPECT_TRUE(sut.value().read({ContentKind::chunk, 0}, bytes));
    const auto last = sut.value().read({ContentKind::chunk, 3}, bytes);
    ASSERT_FALSE(last);
    expect_one_clear_line(last.error().text, path);
    EXPECT_NE(last.error().text.find("chunk 3 at offset "), std::string::npos);
    EXPECT_NE(last.error().text.find("cut short"), std::string::npos);
}

TEST(StoreLink, tells_and_counts_a_damaged_piece_once_however_often_it_is_asked_for)
{
    const TinyModel model = make_tiny_model({.records = 200});
    const TemporaryFolder folder;
    const auto path = folder.write("linked.spm", model.file);
    std::vector<std::string> lines;
    StoreLink sut(ModelStore::open(path).value(),
                  [&lines](const std::string& line) { lines.push_back(line); });
    std::filesystem::resize_file(path, model.file.size() - 10);
    struct Desk final : PieceSink
    {
        void receive(ContentKey key, std::span<const std::byte> /*bytes*/) override
        {
            got.push_back(key);
        }
        std::vector<ContentKey> got;
    } desk;
    const std::array<ContentKey, 2> keys{ContentKey{ContentKind::chunk, 3},
                                         ContentKey{ContentKind::chunk, 0}};
    for (std::uint32_t generation = 0; generation < 3; ++generation)
    {
        sut.request(keys, generation);
        sut.poll(desk);
    }
    EXPECT_EQ(desk.got, std::vector<ContentKey>(3, keys[1]));
    EXPECT_EQ(sut.damaged(), 1U);
    ASSERT_EQ(lines.size(), 1U);
    expect_one_clear_line(lines[0], path);
}

TEST(ModelStore, can_be_moved_and_assigned)
{
    const TemporaryFolder folder;
    const TinyModel model = make_tiny_model({});
    auto first = ModelStore::open(folder.write("a.spm", model.file));
    auto second = ModelStore::open(folder.write("b.spm", make_tiny_model({.seed = 2}).file));
    ASSERT_TRUE(first && second);
    second.value() = std::move(first).value();
    const ModelStore sut(std::move(second).value());
    std::vector<std::byte> bytes;
    ASSERT_TRUE(sut.read({ContentKind::chunk, 1}, bytes));
    EXPECT_TRUE(std::ranges::equal(bytes, model.chunks[1]));
}

TEST(ContentHash, is_the_first_half_of_blake2b_256)
{
    // b2sum -l 256 of nothing, and of the three letters.
    EXPECT_EQ(hash_text(content_hash({})), "0e5751c026e543b2e8ab2eb06099daa1");
    const std::string abc = "abc";
    EXPECT_EQ(hash_text(content_hash(std::as_bytes(std::span(abc)))),
              "bddd813c634239723171ef3fee98579b");
}

TEST(ContentHash, text_is_read_back_and_anything_else_is_refused)
{
    const ContentHash hash = content_hash({});
    EXPECT_EQ(parse_hash(hash_text(hash)), hash);
    EXPECT_EQ(parse_hash("0E5751C026E543B2E8AB2EB06099DAA1"), hash);
    EXPECT_FALSE(parse_hash(""));
    EXPECT_FALSE(parse_hash("0e5751c026e543b2e8ab2eb06099daa"));
    EXPECT_FALSE(parse_hash("0e5751c026e543b2e8ab2eb06099daa12"));
    EXPECT_FALSE(parse_hash("0e5751c026e543b2e8ab2eb06099daag"));
}

TEST(ModelName, allows_1_to_63_bytes_of_letters_and_digits)
{
    EXPECT_TRUE(is_valid_name("a"));
    EXPECT_TRUE(is_valid_name("Stanford-Bunny_2.1"));
    EXPECT_TRUE(is_valid_name(std::string(63, 'x')));
    EXPECT_TRUE(is_valid_name("W\u00FCrfel-\u03B1_\u65E5\u672C"));
    EXPECT_FALSE(is_valid_name(std::string(62, 'x').append("\u00FC")));
    EXPECT_FALSE(is_valid_name(""));
    EXPECT_FALSE(is_valid_name(std::string(64, 'x')));
    for (const char* name : {"a b", "a/b", "a\nb", "a\x1b[31m", "caf\xc3", "a@b", "*", "a\u00A0b",
                             "a\u200Bb", "a\u202Eb", "\u00ABa\u00BB"})
    {
        EXPECT_FALSE(is_valid_name(name)) << printable(name);
    }
}

TEST(ModelName, a_selector_is_a_name_and_perhaps_a_hash_or_a_server)
{
    const auto plain = parse_selector("bunny");
    ASSERT_TRUE(plain);
    EXPECT_EQ(plain.value().name, "bunny");
    EXPECT_FALSE(plain.value().hash);
    const auto pinned = parse_selector("bunny@0e5751c026e543b2e8ab2eb06099daa1");
    ASSERT_TRUE(pinned);
    EXPECT_EQ(pinned.value().hash, content_hash({}));
    EXPECT_TRUE(pinned.value().server.empty());
    for (const char* server : {"lab3", "lab3.example.org:812", "cert:91d177d5d766", "12"})
    {
        const auto of_one = parse_selector(std::string("bunny@") + server);
        ASSERT_TRUE(of_one);
        EXPECT_FALSE(of_one.value().hash);
        EXPECT_EQ(of_one.value().server, server);
    }
    EXPECT_EQ(parse_selector("bunny@lab 3").error().text,
              "'lab 3' after @ is neither a hash of 32 hexadecimal digits nor a server, "
              "MACHINE[:PROCESS] or cert: and 12 digits of 0-9 a-f");
    EXPECT_FALSE(parse_selector("bunny@"));
    EXPECT_FALSE(parse_selector("bunny@" + std::string(81, 'a')));
    EXPECT_EQ(parse_selector("b\tnny").error().text,
              "name 'b?nny' is not 1 to 63 bytes of letters, digits, . _ -");
    EXPECT_FALSE(parse_selector("@0e5751c026e543b2e8ab2eb06099daa1"));
}

} // namespace
} // namespace tactus
