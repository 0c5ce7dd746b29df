'use strict';
// The interop client on @grpc/grpc-js.
// usage: client ROW TARGET | client --version

const { Api } = require('./api');
const { rows, channelOptions } = require('./rows');

function version() {
  const library = require('@grpc/grpc-js/package.json');
  const loader = require('@grpc/proto-loader/package.json');
  return `${library.name} ${library.version} (${loader.name} ${loader.version}, Node ${process.versions.node})`;
}

async function main([row, target]) {
  if (row === '--version') return console.log(version());
  if (!target || !Object.hasOwn(rows, row)) {
    console.error(`usage: client ROW TARGET | client --version\nrows: ${Object.keys(rows).join(' ')}`);
    return process.exit(2);
  }
  const api = new Api(target, channelOptions[row]);
  let code = 0;
  try {
    await rows[row](api);
  } catch (error) {
    console.error(`${row}: ${error.message}`);
    code = 1;
  }
  console.log(`calls ${api.calls}`);
  return process.exit(code);
}

main(process.argv.slice(2));
