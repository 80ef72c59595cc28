#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace cairn::testing {

/// A message of protobuf's wire format, as far as ONNX needs it.
class Message {
 public:
  Message& number(int field, std::uint64_t value) {
    varint(std::uint64_t(field) << 3);
    varint(value);
    return *this;
  }
  Message& text(int field, const std::string& value) {
    varint(std::uint64_t(field) << 3 | 2);
    varint(value.size());
    bytes_ += value;
    return *this;
  }
  Message& message(int field, const Message& value) { return text(field, value.bytes_); }
  const std::string& bytes() const { return bytes_; }

 private:
  void varint(std::uint64_t value) {
    for (; value > 127; value >>= 7) bytes_.push_back(char(value | 128));
    bytes_.push_back(char(value));
  }
  std::string bytes_;
};

/// An ONNX network of 1x1 convolutions of one input, "image", 1 x 3 x height x width: enough for
/// the tests of decoders. Field numbers: onnx.proto (opset 11).
class TinyOnnx {
 public:
  TinyOnnx(int height, int width) : height_(height), width_(width) {}

  /// An output 1 x channels x height x width: bias + weights (channels x 3) times the pixel, then
  /// `activation` (an operator's name), if any.
  TinyOnnx& maps(const std::string& name, const std::vector<float>& weights,
                 const std::vector<float>& bias, const std::string& activation = "") {
    const auto channels = std::int64_t(bias.size());
    floats(name + "_w", {channels, 3, 1, 1}, weights);
    floats(name + "_b", {channels}, bias);
    const std::string before = activation.empty() ? name : name + "_before";
    Message conv = node("Conv", {"image", name + "_w", name + "_b"}, before);
    graph_.message(1, conv.message(5, ints("kernel_shape", {1, 1})));
    if (!activation.empty()) graph_.message(1, node(activation, {before}, name));
    return output(name, {1, channels, height_, width_});
  }

  /// An output N x 3 that is the same for all pictures.
  TinyOnnx& rows(const std::string& name, const std::vector<float>& values) {
    const auto count = std::int64_t(values.size());
    floats(name + "_w", {count, 3, 1, 1}, std::vector<float>(values.size() * 3, 0.f));
    floats(name + "_b", {count}, values);
    Message conv = node("Conv", {"image", name + "_w", name + "_b"}, name + "_maps");
    graph_.message(1, conv.message(5, ints("kernel_shape", {1, 1})));
    graph_.message(1, node("GlobalAveragePool", {name + "_maps"}, name + "_mean"));
    tensor(name + "_shape", {2}, 7, raw(std::vector<std::int64_t>{count / 3, 3}));
    graph_.message(1, node("Reshape", {name + "_mean", name + "_shape"}, name));
    return output(name, {count / 3, 3});
  }

  std::string bytes() const {
    Message graph = graph_, model, opset;
    graph.text(2, "tiny").message(11, value("image", {1, 3, height_, width_}));
    opset.text(1, "").number(2, 11);
    return model.number(1, 6).message(7, graph).message(8, opset).bytes();
  }
  void write(const std::filesystem::path& file) const {
    std::ofstream(file, std::ios::binary) << bytes();
  }

 private:
  template <class T>
  static std::string raw(const std::vector<T>& values) {
    std::string bytes(values.size() * sizeof(T), '\0');
    std::memcpy(bytes.data(), values.data(), bytes.size());
    return bytes;
  }
  static Message node(const std::string& op, const std::vector<std::string>& inputs,
                      const std::string& output) {
    Message node;
    for (const std::string& input : inputs) node.text(1, input);
    return node.text(2, output).text(3, output + "_node").text(4, op);
  }
  static Message ints(const std::string& name, const std::vector<std::uint64_t>& values) {
    Message attribute;
    attribute.text(1, name);
    for (const std::uint64_t value : values) attribute.number(8, value);
    return attribute.number(20, 7);
  }
  static Message value(const std::string& name, const std::vector<std::int64_t>& shape) {
    Message dimensions, tensor, type, info;
    for (const std::int64_t size : shape) {
      dimensions.message(1, Message().number(1, std::uint64_t(size)));
    }
    tensor.number(1, 1).message(2, dimensions);
    return info.text(1, name).message(2, type.message(1, tensor));
  }
  void tensor(const std::string& name, const std::vector<std::int64_t>& shape, int type,
              const std::string& data) {
    Message tensor;
    for (const std::int64_t size : shape) tensor.number(1, std::uint64_t(size));
    graph_.message(5, tensor.number(2, std::uint64_t(type)).text(8, name).text(9, data));
  }
  void floats(const std::string& name, const std::vector<std::int64_t>& shape,
              const std::vector<float>& values) {
    tensor(name, shape, 1, raw(values));
  }
  TinyOnnx& output(const std::string& name, const std::vector<std::int64_t>& shape) {
    graph_.message(12, value(name, shape));
    return *this;
  }

  int height_, width_;
  Message graph_;
};

}  // namespace cairn::testing
