#include <dspace/messages/Sha256.h>

#include <openssl/evp.h>

#include <dspace/Error.h>

namespace dspace::session {

Sha256::Sha256() : Context_(EVP_MD_CTX_new()) {
  if (!this->Context_ ||
      EVP_DigestInit_ex(static_cast<EVP_MD_CTX*>(this->Context_), EVP_sha256(), nullptr) != 1) {
    throw Error(Error::Kind::Internal, "checksum", "SHA-256 is not available");
  }
}

Sha256::~Sha256() {
  EVP_MD_CTX_free(static_cast<EVP_MD_CTX*>(this->Context_));
}

void Sha256::Add(const void* data, std::size_t size) {
  EVP_DigestUpdate(static_cast<EVP_MD_CTX*>(this->Context_), data, size);
}

std::string Sha256::Finish() {
  const auto context = static_cast<EVP_MD_CTX*>(this->Context_);
  std::string digest(32, '\0');
  EVP_DigestFinal_ex(context, reinterpret_cast<unsigned char*>(digest.data()), nullptr);
  EVP_DigestInit_ex(context, nullptr, nullptr); // restarts the digest
  return digest;
}

} // namespace dspace::session
