// Prints what the MCAP file's own library reads of a file, with all checksums, and the messages by a decoder of
// its own:
//   streamed <topic> <type> <nanoseconds> <message as JSON>     in the order of the file
//   indexed <topic> <type> <nanoseconds> <message as JSON>      by the index, in the order of time
//   statistics <messages> <channels> <chunks> <first time> <last time>
// Needs the packages @mcap/core (with @foxglove/crc), @foxglove/rosmsg, @foxglove/rosmsg2-serialization and fzstd
const { crc32 } = require("@foxglove/crc");
const { McapIndexedReader, McapStreamReader } = require("@mcap/core");
const { parse } = require("@foxglove/rosmsg");
const { MessageReader } = require("@foxglove/rosmsg2-serialization");
const { decompress } = require("fzstd");
const fs = require("fs");

const bytes = new Uint8Array(fs.readFileSync(process.argv[2]));
const decompressHandlers = { zstd: (packed) => decompress(packed) };
const numbers = (key, value) => (typeof value === "bigint" ? String(value) : ArrayBuffer.isView(value) ? [...value] : value);

function print(how, schemas, channels, message) {
  const channel = channels.get(message.channelId);
  const schema = schemas.get(channel.schemaId);
  if (schema.encoding !== "ros2msg" || channel.messageEncoding !== "cdr") throw new Error("foreign encodings");
  const definition = parse(new TextDecoder().decode(schema.data), { ros2: true });
  const reader = new MessageReader(definition);
  const value = reader.readMessage(message.data);
  if (reader.lastReadHadTrailingBytes()) throw new Error(`bytes left over in a message of ${channel.topic}`);
  console.log(how, channel.topic, schema.name, String(message.logTime), JSON.stringify(value, numbers));
}

function readStream() {
  const reader = new McapStreamReader({ decompressHandlers, validateCrcs: true });
  const schemas = new Map(), channels = new Map();
  reader.append(bytes);
  for (let record; (record = reader.nextRecord()); ) {
    if (record.type === "Header" && record.profile !== "ros2") throw new Error(`profile ${record.profile}`);
    if (record.type === "Schema") schemas.set(record.id, record);
    if (record.type === "Channel") channels.set(record.id, record);
    if (record.type === "Message") print("streamed", schemas, channels, record);
  }
  if (!reader.done()) throw new Error("the stream has no end");
}

async function readByIndex() {
  const readable = {
    size: async () => BigInt(bytes.length),
    read: async (offset, length) => bytes.slice(Number(offset), Number(offset + length)),
  };
  const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers });
  for await (const message of reader.readMessages({ validateCrcs: true }))
    print("indexed", reader.schemasById, reader.channelsById, message);
  const { messageCount, channelCount, chunkCount, messageStartTime, messageEndTime } = reader.statistics;
  console.log("statistics", String(messageCount), channelCount, chunkCount, String(messageStartTime), String(messageEndTime));
  const dataEnd = Number(reader.footer.summaryStart) - 13;  // that record's length
  if (reader.dataSectionCrc !== crc32(bytes.slice(0, dataEnd))) throw new Error("the data have another checksum");
  if (reader.chunkIndexes.length !== chunkCount) throw new Error("chunks that are not in the index");
}

readStream();
readByIndex();
