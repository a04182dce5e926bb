// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/io/png.h"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <bit>
#include <csetjmp>
#include <cstring>

#include "phiz/core/error.h"
#include "phiz/io/file_bytes.h"
#include "phiz/io/output_file.h"

namespace phiz {

namespace {

constexpr std::size_t best_deflate_ratio = 1032;  // no deflate stream expands more than this

/// What libpng's callbacks need; errors end in a longjmp to the function that called libpng, which holds no object
/// with a destructor.
struct Stream {
  std::string_view input;
  std::size_t offset = 0;
  std::string* output = nullptr;
  char message[160] = "";
};

void on_error(png_structp png, png_const_charp message) {
  auto* stream = static_cast<Stream*>(png_get_error_ptr(png));
  std::snprintf(stream->message, sizeof stream->message, "%s", message);
  png_longjmp(png, 1);
}

void on_warning(png_structp, png_const_charp) {}

void on_read(png_structp png, png_bytep data, std::size_t count) {
  auto* stream = static_cast<Stream*>(png_get_io_ptr(png));
  if (count > stream->input.size() - stream->offset) png_error(png, "the file is cut off");
  std::memcpy(data, stream->input.data() + stream->offset, count);
  stream->offset += count;
}

void on_write(png_structp png, png_bytep data, std::size_t count) {
  static_cast<Stream*>(png_get_io_ptr(png))->output->append(reinterpret_cast<const char*>(data), count);
}

struct Shape {
  png_uint_32 width = 0;
  png_uint_32 height = 0;
  int channels = 0;
  std::size_t row_bytes = 0;
};

/// Reads the header and asks libpng for 8 or 16 bits of grey, RGB or RGBA. False on error.
bool begin_read(png_structp png, png_infop info, Stream& stream, bool deep, Shape& shape) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_read_fn(png, &stream, on_read);
  png_read_info(png, info);
  const int type = png_get_color_type(png, info);
  png_set_expand(png);
  if (type == PNG_COLOR_TYPE_GRAY_ALPHA || png_get_valid(png, info, PNG_INFO_tRNS) != 0) png_set_gray_to_rgb(png);
  if (deep) {
    png_set_expand_16(png);
    if (std::endian::native == std::endian::little) png_set_swap(png);
  } else {
    png_set_scale_16(png);
  }
  png_set_interlace_handling(png);
  png_read_update_info(png, info);
  shape.width = png_get_image_width(png, info);
  shape.height = png_get_image_height(png, info);
  shape.channels = png_get_channels(png, info);
  shape.row_bytes = png_get_rowbytes(png, info);
  return true;
}

bool read_rows(png_structp png, png_bytepp rows) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_read_image(png, rows);
  png_read_end(png, nullptr);
  return true;
}

struct ReadStructs {
  explicit ReadStructs(Stream& stream)
      : png(png_create_read_struct(PNG_LIBPNG_VER_STRING, &stream, on_error, on_warning)),
        info(png_create_info_struct(png)) {}
  ~ReadStructs() { png_destroy_read_struct(&png, &info, nullptr); }
  ReadStructs(const ReadStructs&) = delete;
  ReadStructs& operator=(const ReadStructs&) = delete;
  png_structp png;
  png_infop info;
};

template <class Result>
Result parse(std::string_view bytes, const std::string& where) {
  using Value = typename decltype(Result::pixels)::value_type;
  if (bytes.size() < 8 || png_sig_cmp(reinterpret_cast<png_const_bytep>(bytes.data()), 0, 8) != 0) {
    reject(where, "not a PNG file");
  }
  Stream stream{bytes};
  const ReadStructs structs(stream);
  Shape shape;
  if (!begin_read(structs.png, structs.info, stream, sizeof(Value) == 2, shape)) reject(where, stream.message);
  // Expansion of palettes and bit depths multiplies the bytes of a row by up to 64.
  if (shape.row_bytes / 64 * shape.height > bytes.size() * best_deflate_ratio) {
    reject(where, fmt::format("the header claims {} x {} pixels, more than {} bytes can hold", shape.width,
                              shape.height, bytes.size()));
  }
  Result image;
  image.width = static_cast<int>(shape.width);
  image.height = static_cast<int>(shape.height);
  image.channels = shape.channels;
  image.pixels.resize(shape.row_bytes / sizeof(Value) * shape.height);
  std::vector<png_bytep> rows(shape.height);
  for (std::size_t y = 0; y < rows.size(); ++y) {
    rows[y] = reinterpret_cast<png_bytep>(image.pixels.data()) + y * shape.row_bytes;
  }
  if (!read_rows(structs.png, rows.data())) reject(where, stream.message, "the file is damaged");
  return image;
}

bool write_all(png_structp png, png_infop info, Stream& stream, const Shape& shape, int bits, png_bytepp rows) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_write_fn(png, &stream, on_write, nullptr);
  const int type = shape.channels == 1   ? PNG_COLOR_TYPE_GRAY
                   : shape.channels == 3 ? PNG_COLOR_TYPE_RGB
                                         : PNG_COLOR_TYPE_RGB_ALPHA;
  png_set_IHDR(png, info, shape.width, shape.height, bits, type, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  if (bits == 8 && shape.channels > 1) png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_write_info(png, info);
  if (bits == 16 && std::endian::native == std::endian::little) png_set_swap(png);
  png_write_image(png, rows);
  png_write_end(png, nullptr);
  return true;
}

template <class Picture>
std::string encode(const Picture& image) {
  using Value = typename decltype(Picture::pixels)::value_type;
  const bool channels_known = image.channels == 1 || image.channels == 3 || image.channels == 4;
  const auto count = static_cast<std::size_t>(std::max(image.width, 0)) *
                     static_cast<std::size_t>(std::max(image.height, 0)) * static_cast<std::size_t>(image.channels);
  if (!channels_known || count == 0 || image.pixels.size() != count) {
    fail(fmt::format("cannot write a picture of {} x {} pixels with {} channels and {} values", image.width,
                     image.height, image.channels, image.pixels.size()));
  }
  Shape shape;
  shape.width = static_cast<png_uint_32>(image.width);
  shape.height = static_cast<png_uint_32>(image.height);
  shape.channels = image.channels;
  shape.row_bytes = count / shape.height * sizeof(Value);
  std::string bytes;
  Stream stream;
  stream.output = &bytes;
  std::vector<png_bytep> rows(shape.height);
  for (std::size_t y = 0; y < rows.size(); ++y) {
    // libpng's interface lacks the const; it does not write to the rows.
    rows[y] = reinterpret_cast<png_bytep>(const_cast<Value*>(image.pixels.data())) + y * shape.row_bytes;
  }
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &stream, on_error, on_warning);
  png_infop info = png_create_info_struct(png);
  const bool good = write_all(png, info, stream, shape, 8 * static_cast<int>(sizeof(Value)), rows.data());
  png_destroy_write_struct(&png, &info);
  if (!good) fail(fmt::format("cannot encode the picture: {}", stream.message));
  return bytes;
}

}  // namespace

Image parse_png(std::string_view bytes, const std::string& where) {
  return parse<Image>(bytes, where);
}
DeepImage parse_deep_png(std::string_view bytes, const std::string& where) {
  return parse<DeepImage>(bytes, where);
}
Image read_png(const std::string& path) {
  return parse_png(read_bytes(path), path);
}
DeepImage read_deep_png(const std::string& path) {
  return parse_deep_png(read_bytes(path), path);
}

std::string png_bytes(const Image& image) {
  return encode(image);
}
std::string png_bytes(const DeepImage& image) {
  return encode(image);
}
void write_png(const std::string& path, const Image& image) {
  write_bytes(path, encode(image));
}
void write_png(const std::string& path, const DeepImage& image) {
  write_bytes(path, encode(image));
}

}  // namespace phiz
