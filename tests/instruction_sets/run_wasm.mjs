// Runs a WebAssembly program that uses nothing of the system but its standard streams.
import {readFileSync} from 'node:fs';
import {argv, exit} from 'node:process';
import {WASI} from 'node:wasi';

const wasi = new WASI({version: 'preview1', returnOnExit: true});
const program = await WebAssembly.compile(readFileSync(argv[2]));
exit(wasi.start(await WebAssembly.instantiate(program, wasi.getImportObject())));
