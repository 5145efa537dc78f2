// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/keys/site.hpp"
#include "tests/shared/temporary_folder.hpp"
#include "transport/dds/key_folder.hpp"
#include "transport/dds/openssl_handles.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace tactus
{
namespace
{

namespace fs = std::filesystem;
using keys::IssuedKeys;
using keys::Role;
using keys::Site;

constexpr std::time_t kOneDay = 24 * 3'600;
constexpr std::uint32_t kDomain = 7;

std::string text_in(const fs::path& path)
{
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// A site whose keys lie in a folder of the test.
struct KeysOfASite : ::testing::Test
{
    KeysOfASite()
    {
        site.domain = kDomain;
        site.members = {{Role::server, "station"},
                        {Role::controller, "hand-1"},
                        {Role::controller, "hand-2"},
                        {Role::viewer, "desk"}};
        site.authority = (folder.path() / "authority").string();
        site.output = (folder.path() / "machines").string();
    }

    std::vector<IssuedKeys> make(std::time_t at)
    {
        auto made = make_keys(site, at);
        EXPECT_TRUE(made) << made.error().text;
        return made ? std::move(made).value() : std::vector<IssuedKeys>();
    }
    [[nodiscard]] fs::path keys_of(const std::string& name) const
    {
        return fs::path(site.output) / name;
    }
    /// Why hand-1 is refused; empty when it isn't.
    [[nodiscard]] std::string why_refused(std::time_t at, std::uint32_t domain = kDomain) const
    {
        const std::string path = keys_of("hand-1").string();
        const auto read = dds::read_key_folder(path, domain, at);
        const std::string line = read ? "" : read.error().text;
        const std::string begin = "--security: " + path + ": ";
        EXPECT_EQ(line.find('\n'), std::string::npos);
        return line.starts_with(begin) ? line.substr(begin.size()) : line;
    }
    void put(const std::string& name, const char* file, const std::string& bytes) const
    {
        std::ofstream(keys_of(name) / file, std::ios::binary) << bytes;
    }

    test::TemporaryFolder folder{"keys"};
    Site site;
    std::time_t now{std::time(nullptr)};
};

} // namespace

TEST_F(KeysOfASite, are_taken_by_the_programs_that_they_are_for)
{
    for (const IssuedKeys& keys : make(now))
    {
        EXPECT_TRUE(keys.is_new);
        const auto read = dds::read_key_folder(keys_of(keys.member.name).string(), kDomain, now);
        ASSERT_TRUE(read) << read.error().text;
        EXPECT_EQ(read.value().name, keys.member.name);
        EXPECT_NEAR(static_cast<double>(read.value().valid_until - now), 365.0 * kOneDay, 2.0);
    }
}

TEST_F(KeysOfASite, stay_until_they_are_renewed_revoked_or_ended)
{
    make(now);
    const std::string before = text_in(keys_of("hand-1") / dds::kKeyFile);
    const std::string other = text_in(keys_of("hand-2") / dds::kKeyFile);
    make(now + kOneDay);
    EXPECT_EQ(text_in(keys_of("hand-1") / dds::kKeyFile), before);
    site.renewed = {"hand-1"};
    make(now + kOneDay);
    const std::string renewed = text_in(keys_of("hand-1") / dds::kKeyFile);
    EXPECT_NE(renewed, before);
    site.renewed.clear();
    site.revoked = {"hand-1"};
    make(now + kOneDay);
    EXPECT_NE(text_in(keys_of("hand-1") / dds::kKeyFile), renewed);
    EXPECT_EQ(why_refused(now + kOneDay), "");
    EXPECT_EQ(text_in(keys_of("hand-2") / dds::kKeyFile), other);
    site.revoked.clear();
    make(now + 366 * kOneDay);
    EXPECT_NE(text_in(keys_of("hand-2") / dds::kKeyFile), other);
}

TEST_F(KeysOfASite, of_another_authority_are_all_made_again)
{
    make(now);
    site.authority += "-2";
    for (const IssuedKeys& keys : make(now))
    {
        EXPECT_TRUE(keys.is_new) << keys.member.name;
    }
    EXPECT_EQ(why_refused(now), "");
}

/// A new authority is prepared while programs still use the present one.
TEST_F(KeysOfASite, of_the_next_authority_leave_the_present_ones_alone)
{
    make(now);
    const std::string present = text_in(keys_of("hand-1") / dds::kKeyFile);
    Site next = site;
    next.authority += "-next";
    next.output += "-next";
    ASSERT_TRUE(make_keys(next, now));
    EXPECT_EQ(text_in(keys_of("hand-1") / dds::kKeyFile), present);
    EXPECT_EQ(why_refused(now), "");
    EXPECT_TRUE(dds::read_key_folder(next.output + "/hand-1", kDomain, now));
    const fs::path ca = fs::path(next.output) / "hand-1" / dds::kIdentityCaFile;
    put("hand-1", dds::kIdentityCaFile,
        text_in(keys_of("hand-1") / dds::kIdentityCaFile) + text_in(ca));
    EXPECT_EQ(why_refused(now), "identity_ca.pem has 2 certificates; Cyclone DDS reads one");
}

TEST_F(KeysOfASite, are_in_an_archive_with_the_right_modes_and_owner)
{
    make(now);
    const std::string command =
        fmt::format("tar --numeric-owner -tvf {}.tar 2>&1", keys_of("hand-1").string());
    std::FILE* list = ::popen(command.c_str(), "r");
    ASSERT_NE(list, nullptr);
    std::set<std::string> found;
    char mode[16] = "";
    char owner[16] = "";
    char name[64] = "";
    while (std::fscanf(list, "%15s %15s %*s %*s %*s %63s", mode, owner, name) == 3)
    {
        found.insert(fmt::format("{} {} {}", mode, owner, name));
    }
    EXPECT_EQ(::pclose(list), 0);
    std::set<std::string> expected{"drwxr-xr-x 0/0 tactus/keys/hand-1/",
                                   "-rw-r--r-- 0/0 systemd/system/hrtc.service.d/keys.conf"};
    for (const char* file : dds::kKeyFiles)
    {
        expected.insert(
            fmt::format("{} 0/0 tactus/keys/hand-1/{}",
                        file == std::string(dds::kKeyFile) ? "-rw-------" : "-rw-r--r--", file));
    }
    EXPECT_EQ(found, expected);
}

TEST_F(KeysOfASite, are_given_to_the_service_of_their_role)
{
    make(now);
    const std::map<std::string, std::string> services{
        {"station", "spm_publish"}, {"hand-1", "hrtc"}, {"hand-2", "hrtc"}, {"desk", "spm_view"}};
    for (const auto& [who, service] : services)
    {
        const std::string archive = text_in(keys_of(who).string() + ".tar");
        EXPECT_NE(archive.find(fmt::format("systemd/system/{}.service.d/keys.conf", service)),
                  std::string::npos);
        EXPECT_NE(archive.find("\nEnvironment=\"KEYS=--security %d --require-security\"\n"),
                  std::string::npos);
        for (const char* file : dds::kKeyFiles)
        {
            const std::string line =
                fmt::format("\nLoadCredential={1}:/etc/tactus/keys/{0}/{1}\n", who, file);
            EXPECT_NE(archive.find(line), std::string::npos) << line;
        }
    }
}

TEST_F(KeysOfASite, that_are_not_whole_are_refused_by_the_file)
{
    make(now);
    for (const char* file : dds::kKeyFiles)
    {
        const fs::path path = keys_of("hand-1") / file;
        fs::rename(path, path.string() + "-");
        EXPECT_EQ(why_refused(now), fmt::format("lacks {}", file));
        put("hand-1", file, "nonsense");
        EXPECT_TRUE(why_refused(now).starts_with(
            file == std::string(dds::kKeyFile) ? "other users may read identity.key" : file))
            << why_refused(now);
        fs::rename(path.string() + "-", path);
        EXPECT_EQ(why_refused(now), "");
    }
    fs::remove(keys_of("hand-1") / dds::kCrlFile);
    fs::remove(keys_of("hand-1") / dds::kIdentityFile);
    EXPECT_EQ(why_refused(now), "lacks identity.pem, crl.pem");
    fs::remove_all(keys_of("hand-1"));
    EXPECT_EQ(why_refused(now), "is no folder");
}

TEST_F(KeysOfASite, that_others_may_read_are_refused)
{
    make(now);
    const fs::path key = keys_of("hand-1") / dds::kKeyFile;
    for (const auto others : {fs::perms::others_read, fs::perms::others_write})
    {
        fs::permissions(key, fs::perms::owner_read | others);
        EXPECT_EQ(why_refused(now),
                  "other users may read identity.key; chmod 600 makes it a secret");
    }
    fs::permissions(key, fs::perms::owner_read | fs::perms::group_read);
    EXPECT_EQ(why_refused(now), "");
}

TEST_F(KeysOfASite, hold_for_their_time)
{
    make(now);
    const std::string early = why_refused(now - 2 * kOneDay);
    EXPECT_TRUE(early.starts_with("the clock of this machine, ")) << early;
    EXPECT_NE(early.find(" is before identity_ca.pem, which begins "), std::string::npos) << early;
    EXPECT_TRUE(why_refused(now + 366 * kOneDay).starts_with("identity.pem ended "));
    site.days = 10; // The certificates stay, the list of what is revoked is signed for ten days.
    make(now);
    EXPECT_EQ(why_refused(now + 9 * kOneDay), "");
    EXPECT_TRUE(why_refused(now + 11 * kOneDay).starts_with("crl.pem is too old: it ended "));
}

TEST_F(KeysOfASite, are_of_one_domain)
{
    make(now);
    EXPECT_EQ(why_refused(now, 8), "governance.p7s is for another domain than 8");
    const std::string permissions = text_in(keys_of("hand-1") / dds::kPermissionsFile);
    site.domain = 8;
    make(now);
    put("hand-1", dds::kPermissionsFile, permissions);
    EXPECT_EQ(why_refused(now, 8), "permissions.p7s is for another domain than 8");
    for (const std::uint32_t domain : {231U, 232U})
    {
        EXPECT_EQ(
            why_refused(now, domain),
            fmt::format("--security: DDS domain {} can't be protected: Cyclone DDS does so up "
                        "to 230",
                        domain));
    }
}

TEST_F(KeysOfASite, that_are_revoked_anothers_or_a_strangers_are_refused)
{
    make(now);
    const std::string first = text_in(keys_of("hand-1") / dds::kIdentityFile);
    const std::string first_key = text_in(keys_of("hand-1") / dds::kKeyFile);
    site.revoked = {"hand-1"};
    make(now);
    put("hand-1", dds::kIdentityFile, first);
    EXPECT_EQ(why_refused(now), "identity.key is not the key of identity.pem");
    put("hand-1", dds::kKeyFile, first_key);
    EXPECT_EQ(why_refused(now), "identity.pem is revoked");
    site.revoked.clear();
    site.authority += "-of-a-stranger";
    const std::string ours = text_in(keys_of("station") / dds::kIdentityCaFile);
    make(now);
    put("hand-1", dds::kIdentityCaFile, ours);
    EXPECT_TRUE(why_refused(now).starts_with("identity.pem is not of identity_ca.pem: "))
        << why_refused(now);
}

/// One changed letter, and documents that the controller signed by itself.
TEST_F(KeysOfASite, with_rights_of_their_own_making_are_refused)
{
    make(now);
    const std::string signed_text = text_in(keys_of("hand-1") / dds::kPermissionsFile);
    std::string changed = signed_text;
    changed.replace(changed.find("hand-1.*"), 8, "hand-2.*");
    put("hand-1", dds::kPermissionsFile, changed);
    const std::string refusal =
        "permissions.p7s was changed, or permissions_ca.pem did not sign it";
    EXPECT_EQ(why_refused(now), refusal);
    const auto certificate =
        openssl::read_certificate((keys_of("hand-1") / dds::kIdentityFile).string());
    const auto key = openssl::read_key((keys_of("hand-1") / dds::kKeyFile).string());
    const std::string document =
        keys::permissions(Role::server, "hand-1", kDomain, now, now + kOneDay);
    const openssl::Bio in(BIO_new_mem_buf(document.data(), static_cast<int>(document.size())));
    const openssl::SignedText own(
        PKCS7_sign(certificate.get(), key.get(), nullptr, in.get(), PKCS7_TEXT));
    const openssl::Bio out(BIO_new_file((keys_of("hand-1") / dds::kPermissionsFile).c_str(), "w"));
    ASSERT_EQ(SMIME_write_PKCS7(out.get(), own.get(), nullptr, PKCS7_TEXT), 1);
    ASSERT_EQ(BIO_flush(out.get()), 1);
    EXPECT_EQ(why_refused(now), refusal);
}

TEST_F(KeysOfASite, of_names_that_were_never_issued_cannot_be_revoked)
{
    site.revoked = {"hand-9"};
    const auto made = make_keys(site, now);
    ASSERT_FALSE(made);
    EXPECT_EQ(made.error().text,
              fmt::format("--revoke: 'hand-9' has no certificate of {}", site.authority));
    EXPECT_FALSE(fs::exists(site.output));
}

TEST_F(KeysOfASite, leave_the_authority_to_its_user)
{
    make(now);
    EXPECT_EQ(fs::status(site.authority).permissions(), fs::perms::owner_all);
    EXPECT_EQ(fs::status(keys_of("hand-1")).permissions(), fs::perms::owner_all);
    for (const auto& entry : fs::recursive_directory_iterator(site.output))
    {
        EXPECT_NE(entry.path().extension(), ".srl");
        EXPECT_FALSE(entry.path().filename().string().ends_with("_ca.key")) << entry.path();
    }
}

TEST_F(KeysOfASite, that_others_may_change_are_refused)
{
    make(now);
    const fs::path ca = keys_of("hand-1") / dds::kIdentityCaFile;
    fs::permissions(ca, fs::perms::others_write, fs::perm_options::add);
    EXPECT_EQ(why_refused(now), "other users may change identity_ca.pem; chmod o-w protects it");
    fs::permissions(ca, fs::perms::others_write, fs::perm_options::remove);
    EXPECT_EQ(why_refused(now), "");
    fs::permissions(keys_of("hand-1"), fs::perms::others_write, fs::perm_options::add);
    EXPECT_EQ(why_refused(now), "other users may change the folder; chmod o-w protects it");
}

TEST_F(KeysOfASite, with_the_rights_of_another_name_or_another_list_are_refused)
{
    make(now);
    const std::string rights = text_in(keys_of("hand-1") / dds::kPermissionsFile);
    put("hand-1", dds::kPermissionsFile, text_in(keys_of("hand-2") / dds::kPermissionsFile));
    EXPECT_EQ(why_refused(now), "permissions.p7s gives no rights to 'hand-1'");
    put("hand-1", dds::kPermissionsFile, rights);
    EXPECT_EQ(why_refused(now), "");
    Site theirs = site;
    theirs.authority += "-of-a-stranger";
    theirs.output += "-of-a-stranger";
    ASSERT_TRUE(make_keys(theirs, now));
    put("hand-1", dds::kCrlFile, text_in(fs::path(theirs.output) / "hand-1" / dds::kCrlFile));
    EXPECT_EQ(why_refused(now), "crl.pem is not of identity_ca.pem");
}

/// A run that was interrupted between two files, and a folder that was renamed.
TEST_F(KeysOfASite, that_do_not_belong_together_are_made_again)
{
    make(now);
    put("hand-1", dds::kKeyFile, text_in(keys_of("hand-2") / dds::kKeyFile));
    EXPECT_EQ(why_refused(now), "identity.key is not the key of identity.pem");
    for (const IssuedKeys& keys : make(now))
    {
        EXPECT_EQ(keys.is_new, keys.member.name == "hand-1") << keys.member.name;
    }
    EXPECT_EQ(why_refused(now), "");
    fs::remove_all(keys_of("hand-1"));
    fs::rename(keys_of("hand-2"), keys_of("hand-1"));
    make(now);
    EXPECT_EQ(why_refused(now), "");
}

TEST_F(KeysOfASite, end_with_their_authority)
{
    constexpr int kDaysOfAuthority = 3'650;
    make(now);
    const std::time_t late = now + (kDaysOfAuthority - 10) * kOneDay;
    make(late);
    const auto read = dds::read_key_folder(keys_of("hand-1").string(), kDomain, late);
    ASSERT_TRUE(read) << read.error().text;
    EXPECT_NEAR(static_cast<double>(read.value().valid_until - late), 10.0 * kOneDay, 2.0);
    const auto refused = make_keys(site, now + (kDaysOfAuthority + 1) * kOneDay);
    ASSERT_FALSE(refused);
    EXPECT_TRUE(refused.error().text.starts_with("--authority: the authority in " + site.authority +
                                                 " ended "))
        << refused.error().text;
}

TEST_F(KeysOfASite, leave_folders_with_other_files_alone)
{
    fs::create_directories(site.authority);
    fs::permissions(site.authority, fs::perms::others_read, fs::perm_options::add);
    const auto before = fs::status(site.authority).permissions();
    std::ofstream(fs::path(site.authority) / "letter.txt") << "hello";
    const auto refused = make_keys(site, now);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().text,
              "--authority: " + site.authority +
                  " has other files and no authority; choose an empty folder");
    EXPECT_EQ(fs::status(site.authority).permissions(), before);
}

/// Expected digits: those with which Cyclone 0.10.2 began the GUIDs of these certificates.
TEST(CertificateDigits, are_those_of_cyclones_plugin)
{
    EXPECT_EQ(dds::certificate_digits("host"), "91d177d5d766");
    EXPECT_EQ(dds::certificate_digits("c1"), "cf35ace75f00");
    EXPECT_EQ(dds::certificate_digits("c2"), "f1f15a6b74a2");
}

} // namespace tactus
