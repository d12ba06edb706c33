/// Certificates made for a test: an authority, and what it vouches for. Nothing of them is kept.
#pragma once

#include <gtest/gtest.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/x509v3.h>
#include <stdlib.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

namespace huestep::test {

class Certificates {
 public:
    /// `names`: as OpenSSL writes them, "DNS:localhost,IP:127.0.0.1". `days` below 0: the server's
    /// expired so long ago.
    explicit Certificates(const std::string& names = "DNS:localhost,IP:127.0.0.1", long days = 1) {
        std::string pattern = testing::TempDir() + "huestep_tls_XXXXXX";
        m_folder = ::mkdtemp(pattern.data());
        const Key authority(EVP_EC_gen("P-256"));
        const Certificate root = make("Test authority", authority.get(), 1, "CA:TRUE",
                                      NID_basic_constraints, nullptr, authority.get());
        const Key own(EVP_EC_gen("P-256"));
        const Certificate server = make("server", own.get(), days, names, NID_subject_alt_name,
                                        root.get(), authority.get());
        save("ca.pem", [&](FILE* file) { return PEM_write_X509(file, root.get()); });
        save("cert.pem", [&](FILE* file) { return PEM_write_X509(file, server.get()); });
        save("key.pem", [&](FILE* file) {
            return PEM_write_PrivateKey(file, own.get(), nullptr, nullptr, 0, nullptr, nullptr);
        });
    }
    ~Certificates() { std::filesystem::remove_all(m_folder); }
    Certificates(const Certificates&) = delete;
    Certificates& operator=(const Certificates&) = delete;

    [[nodiscard]] std::string authority() const { return m_folder + "/ca.pem"; }
    [[nodiscard]] std::string certificate() const { return m_folder + "/cert.pem"; }
    [[nodiscard]] std::string key() const { return m_folder + "/key.pem"; }

 private:
    struct Free {
        void operator()(EVP_PKEY* key) const { EVP_PKEY_free(key); }
        void operator()(X509* certificate) const { X509_free(certificate); }
    };
    using Key = std::unique_ptr<EVP_PKEY, Free>;
    using Certificate = std::unique_ptr<X509, Free>;

    /// `by` null: it vouches for itself.
    static Certificate make(const char* name, EVP_PKEY* key, long days,
                            const std::string& extension, int kind, X509* by, EVP_PKEY* signer) {
        Certificate out(X509_new());
        X509_set_version(out.get(), X509_VERSION_3);
        ASN1_INTEGER_set(X509_get_serialNumber(out.get()), by ? 2 : 1);
        X509_gmtime_adj(X509_getm_notBefore(out.get()), -10L * 86'400);
        X509_gmtime_adj(X509_getm_notAfter(out.get()), days * 86'400);
        X509_set_pubkey(out.get(), key);
        X509_NAME_add_entry_by_txt(X509_get_subject_name(out.get()), "CN", MBSTRING_ASC,
                                   reinterpret_cast<const unsigned char*>(name), -1, -1, 0);
        X509_set_issuer_name(out.get(), X509_get_subject_name(by ? by : out.get()));
        X509_EXTENSION* added = X509V3_EXT_conf_nid(nullptr, nullptr, kind, extension.c_str());
        EXPECT_NE(added, nullptr) << extension;
        X509_add_ext(out.get(), added, -1);
        X509_EXTENSION_free(added);
        EXPECT_NE(X509_sign(out.get(), signer, EVP_sha256()), 0);
        return out;
    }

    template <class Write>
    void save(const char* name, Write write) const {
        FILE* const file = std::fopen((m_folder + "/" + name).c_str(), "w");
        ASSERT_NE(file, nullptr);
        EXPECT_EQ(write(file), 1) << name;
        EXPECT_EQ(std::fclose(file), 0) << name;
    }

    std::string m_folder;
};

}  // namespace huestep::test
