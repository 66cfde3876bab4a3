#include <dspace/import/vrml/text/VrmlText.h>

#include <dspace/import/files/ImportFile.h>

#include <dspace/Error.h>
#include <dspace/FileText.h>
#include <dspace/Utf8.h>

#include <zlib.h>

#include <algorithm>

namespace dspace {

namespace {

constexpr std::size_t MaximumText = std::size_t(512) << 20;

std::string Gunzip(const std::string& packed, const std::string& path) {
  z_stream stream = {};
  if (inflateInit2(&stream, 15 + 16) != Z_OK) {
    throw Error(Error::Kind::Resource, FileObject(path), "gzip could not be started");
  }
  struct Guard {
    z_stream& stream;
    ~Guard() { inflateEnd(&this->stream); }
  } guard{stream};
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  stream.avail_in = static_cast<uInt>(packed.size());
  std::string text;
  int status = Z_OK;
  while (status == Z_OK) {
    const std::size_t filled = text.size();
    if (filled >= MaximumText) {
      throw Error(Error::Kind::Resource, FileObject(path),
                  "unpacks to more than " + std::to_string(MaximumText) + " bytes");
    }
    text.resize(std::max<std::size_t>(65536, filled * 2));
    stream.next_out = reinterpret_cast<Bytef*>(text.data() + filled);
    stream.avail_out = static_cast<uInt>(text.size() - filled);
    status = inflate(&stream, Z_NO_FLUSH);
    text.resize(text.size() - stream.avail_out);
    if (status == Z_OK && stream.avail_in == 0 && stream.avail_out != 0) {
      break; // the input ended before the stream did
    }
  }
  if (status != Z_STREAM_END) {
    throw Error(Error::Kind::Corrupt, FileObject(path), "its gzip stream is damaged or cut short");
  }
  return text;
}

bool StartsWith(const std::string& text, const char* prefix) {
  return text.rfind(prefix, 0) == 0;
}

} // namespace

VrmlText ReadVrmlText(const std::string& path) {
  std::string text = ReadFileBytes(path, MaximumText);
  if (StartsWith(text, "\x1f\x8b")) {
    text = Gunzip(text, path);
  }
  text = ToFileText(std::move(text), FileObject(path));
  if (StartsWith(text, "\xef\xbb\xbf")) {
    text.erase(0, 3); // byte order mark
  }
  const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
  const std::string header = Utf8Beginning(std::string_view(text).substr(0, end), 200);
  VrmlText result;
  if (StartsWith(header, "#VRML V2.0 utf8")) {
    result.dialect = VrmlDialect::Vrml2;
    result.header = "#VRML V2.0 utf8";
  } else if (StartsWith(header, "#VRML V1.0 ascii")) {
    result.dialect = VrmlDialect::Vrml1;
    result.header = "#VRML V1.0 ascii";
  } else if (StartsWith(header, "#Inventor V2.") && header.find("ascii") != std::string::npos) {
    result.dialect = VrmlDialect::Vrml1;
    result.header = "#Inventor V2.1 ascii";
  } else if (StartsWith(header, "#VRML ") || StartsWith(header, "#Inventor ")) {
    throw Error(Error::Kind::Unsupported, FileObject(path),
                "'" + header +
                    "' is not read; VRML V2.0 utf8, VRML V1.0 ascii and Inventor V2 "
                    "ascii are");
  } else {
    throw Error(Error::Kind::Corrupt, FileObject(path),
                "does not begin with '#VRML V2.0 utf8', '#VRML V1.0 ascii' or '#Inventor V2.'");
  }
  if (text.find('\0') != std::string::npos) {
    throw Error(Error::Kind::Corrupt, FileObject(path), "has NUL bytes: it is not a text file");
  }
  result.body = text.substr(end);
  return result;
}

} // namespace dspace
