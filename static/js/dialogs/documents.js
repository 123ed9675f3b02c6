/** New documents: each has its own address, and the page goes there. */

/**
 * @param {any} wanted `{garment}` or nothing for a blank board
 * @returns {Promise<Response>} what the server answered, if it was no new document
 */
export async function goToNew(wanted) {
  const answer = await fetch("../api/documents", {
    method: "POST",
    headers: { "content-type": "application/json" },
    body: JSON.stringify(wanted),
  });
  if (answer.status === 201) location.assign(answer.headers.get("location") ?? "../");
  return answer;
}
